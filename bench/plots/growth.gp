# needs: growth.csv
# size: 1100,420
set termoption noenhanced
table = results.'/growth.csv'
array curves = ['parts of one world', 'worlds of 16 parts']
array solvers = ['sphere', 'bullet', 'sphere/thesis', 'sphere/gpu']
set logscale xy
set format '%g'
set xtics auto rotate by -35
set rmargin 6
set multiplot layout 1, 3 title 'How the cost of a step grows (heaps, every part awake)'
at(c, s, y) = strcol('over') eq curves[c] && strcol('solver') eq solvers[s] && strcol('x') ne 'exponent' ? column(y) : NaN
do for [c=1:2] {
  set xlabel curves[c]
  set ylabel 'CPU us a part and step'
  if (c == 1) { set key inside top right samplen 1 font ',9'; set yrange [1:1e6] } else { unset key; set yrange [*:*] }
  plot for [s=1:4] table using 'x':(at(c, s, 'part_cpu_us')) with linespoints linetype s title solvers[s]
}
set xlabel curves[1]
set ylabel 'memory added, MB'
plot for [s=1:4] table using 'x':(at(1, s, 'added_mb')) with linespoints linetype s title solvers[s]
unset multiplot

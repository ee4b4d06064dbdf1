# needs: scenes.csv
set termoption noenhanced
table = results.'/scenes.csv'
parts = system("awk -F, '!/^#/ && $1 != \"part\" && !seen[$1]++ { printf \"%s \", $1 }' '".table."'")
array solvers = ['sphere', 'bullet']
set logscale xy
set format '%g'
set xlabel 'parts in the bin'
set xtics (16, 64, 256, 512)
array columns = ['cpu_s', 'penetration_p95_rel']
array labels = ['CPU s a scene', 'penetration p95 / diagonal']
shown(y) = y < 1e-5 ? 1e-5 : y
set multiplot layout 1, 2 title 'Scenes: cost and error over the number of parts'
do for [k=1:2] {
  set ylabel labels[k]
  if (k == 2) { set key outside right top Left reverse samplen 1 font ',10' ; set rmargin 24 } else { set key off }
  plot for [p=1:words(parts)] for [s=1:2] \
    table using 'bodies':(strcol('part') eq word(parts, p) && strcol('solver') eq solvers[s] ? shown(column(columns[k])) : NaN) \
      with linespoints linetype p dashtype s title word(parts, p).', '.solvers[s]
}
unset multiplot

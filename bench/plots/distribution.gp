# needs: distribution.csv
# size: 900,900
set termoption noenhanced
# A panel for each part of the table.
table = results.'/distribution.csv'
measures = system("awk -F, '!/^#/ && $1 != \"part\" && !seen[$4]++ { printf \"\\\"%s\\\" \", $4 }' '".table."'")
parts = system("awk -F, '!/^#/ && $1 != \"part\" && !seen[$1]++ { printf \"%s \", $1 }' '".table."'")
set ylabel 'relative'
set yrange [0:*]
set xrange [0.5:words(measures) + 0.5]
set xtics ()
do for [i=1:words(measures)] { set xtics add (word(measures, i) i) }
set xtics font ',10'
at(name) = sum [i=1:words(measures)] (word(measures, i) eq name ? i : 0)
array solvers = ['sphere', 'sphere coarse', 'sphere coarser', 'sphere/gpu', 'bullet']
set key off
set multiplot layout words(parts), 1 \
  title 'Distance from the reference / 95th percentile of its distance from itself: below 1 is within its noise'
do for [p=1:words(parts)] {
  part = word(parts, p)
  set title part offset 0, -0.6
  if (p == words(parts)) { set key outside bottom center horizontal }
  plot 1 with lines linecolor rgb '#999999' dashtype 2 notitle, for [s=1:|solvers|] table \
    using (at(strcol('measure')) + 0.12 * (s - 3)):(strcol('part') eq part ? \
      only('solver', solvers[s], 'wasserstein') / column('reference_to_itself_p95') : NaN) \
    with points linetype s pointsize 1.3 title solvers[s]
}
unset multiplot

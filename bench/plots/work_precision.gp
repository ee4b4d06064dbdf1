# needs: work_precision.csv
# size: 900,1100
set termoption noenhanced
# A panel for each part and error that the table has figures of.
table = results.'/work_precision.csv'
parts_with(name) = system("awk -F, '/^part,/ { for (i = 1; i <= NF; ++i) if ($i == \"".name."\") c = i; next } \
  c && $c != \"\" && !seen[$1]++ { printf \"%s \", $1 }' '".table."'")
set logscale xy  # the same ranges in all panels, so that parts compare
set format '%g'
set xlabel 'CPU s a scene'
array names = ['sphere: default', 'sphere: finish', 'sphere: quick', 'sphere: time step', 'sphere: sub-steps', 'sphere: samples', 'sphere: field cell', \
  'sphere/thesis', 'bullet, sleeping', 'bullet, no sleeping', 'Bullet as it comes', 'the same: iterations', \
  'ODE', 'ODE: iterations', 'DART']
array series = ['sphere|yes|default', 'sphere|yes|finish', 'sphere/quick|yes|default', 'sphere|yes|time_step', 'sphere|yes|sub_steps', 'sphere|yes|fine_samples', \
  'sphere|yes|field_cell', 'sphere/thesis|no|default', 'bullet|yes|time_step', 'bullet|no|time_step', \
  'bullet_stock|yes|time_step', 'bullet_stock|yes|iterations', 'ode|no|time_step', 'ode|no|iterations', 'dart|no|time_step']
array colours = ['#000000', '#000000', '#000000', '#0072b2', '#0072b2', '#0072b2', '#0072b2', '#009e73', '#d55e00', '#d55e00', '#d55e00', '#d55e00', \
  '#cc79a7', '#cc79a7', '#e69f00']
array shapes = [3, 1, 2, 7, 6, 4, 8, 9, 5, 4, 2, 1, 11, 10, 13]
name(i) = strcol('solver').'|'.strcol('sleeping').'|'.strcol('varied') eq series[i]
# Nothing to see below one part in 100,000: rounding.
shown(y) = y < 1e-5 ? 1e-5 : y
array errors = ['penetration_p95_rel', 'drift_p95_rel']
array fronts = ['front_penetration', 'front_drift']
array labels = ['penetration p95 / diagonal', 'drift p95 / diagonal']
array goals = [0.003, 0.01]
array parts[2]
parts[1] = parts_with(errors[1])
parts[2] = parts_with(errors[2])
columns = 5
panels = words(parts[1]) + words(parts[2]) + 1
set key off
set xrange [0.03:300]
set yrange [1e-5:1]
set xtics 100
set ytics 10
set multiplot layout (panels + columns - 1) / columns, columns title 'Error over time; line: Pareto front, grey: goal'
do for [e=1:2] {
  do for [p=1:words(parts[e])] {
    part = word(parts[e], p)
    set title part offset 0, -0.6
    set ylabel p == 1 || (e == 1 ? p - 1 : words(parts[1]) + p - 1) % columns == 0 ? labels[e] : ''
    plot goals[e] with lines linecolor rgb '#999999' dashtype 2 notitle, \
      table using (strcol('part') eq part && strcol(fronts[e]) eq 'yes' ? column('cpu_s') : NaN):(shown(column(errors[e]))) \
        smooth unique with lines linecolor rgb '#bbbbbb' linewidth 3 notitle, \
      for [i=1:|series|] table using (strcol('part') eq part && name(i) ? column('cpu_s') : NaN):(shown(column(errors[e]))) \
        with points pointtype shapes[i] linecolor rgb colours[i] pointsize (i <= 3 ? 1.8 : 1) notitle
  }
}
# The key, in a panel of its own.
unset logscale
unset border
unset tics
unset title
unset xlabel
unset ylabel
set key left top Left reverse samplen 0.5 font ',8' spacing 0.9
plot [0:1] [0:1] NaN notitle, \
  for [i=1:|series|] keyentry with points pointtype shapes[i] linecolor rgb colours[i] title names[i]
unset multiplot

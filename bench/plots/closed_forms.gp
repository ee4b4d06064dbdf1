# needs: closed_forms.csv
table = results.'/closed_forms.csv'
forms = 'bounce_0.9 sliding_distance friction_angle rolling_15_deg tumbling_energy tumbling_spin stack_10_boxes_30_s two_rods'
goal = '0.01 0.005 0.5 0.002 0.001 0.001 0.001 0.01'
solvers = 'sphere bullet sphere/thesis'
set multiplot layout 3,3 title 'Error against closed forms over time steps (dashed: goal at default steps)'
set logscale xy
set format y '10^{%T}'
set xtics ('1/30' 1/30., '1/200' 1/200., '1/1000' 0.001)
set xrange [0.0008:0.04]
set yrange [1e-7:*]
set xlabel 's' offset 0,0.7
unset key
error(form, solver) = stringcolumn('form') eq form && stringcolumn('solver') eq solver && column('error') > 0 ? column('error') : NaN
do for [f=1:words(forms)] {
  set title word(forms, f) noenhanced offset 0,-0.7
  plot word(goal, f) + 0 with lines linecolor rgb '#888888' dashtype 2, \
       for [s=1:3] table using 'time_step_s':(error(word(forms, f), word(solvers, s))) with linespoints linetype s
}
unset title
unset border
unset tics
unset xlabel
unset logscale
unset grid
set key center center Left reverse
set xrange [0:1]
set yrange [0:1]
plot for [s=1:3] NaN with linespoints linetype s title word(solvers, s)
unset multiplot

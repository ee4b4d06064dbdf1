# needs: closed_forms.csv
table = results.'/closed_forms.csv'
forms = 'free_fall bounce_0.9 sliding_distance friction_angle rolling_15_deg collision_momentum collision_energy_gain tumbling_energy tumbling_energy_gain tumbling_spin stack_10_boxes_30_s brick_stacks_mean brick_stacks_worst two_rods'
goal = '0.0001 0.01 0.005 0.5 0.002 0.00001 0.00001 0.001 0.0001 0.001 0.001 0.001 0.001 0.01'
solvers = 'sphere bullet sphere/thesis'
least = 1e-8  # what is smaller is drawn here
set multiplot layout 4,4 title 'Error against closed forms over time steps (dashed: goal at default steps; p: order)'
set logscale xy
set format y '10^{%T}'
set xtics ('1/30' 1/30., '1/200' 1/200., '1/1000' 0.001)
set ytics 1e-8,1e3 font ',9'
set xtics font ',9'
set xrange [0.0008:0.04]
set yrange [least / 2:*]
set key inside bottom right samplen 0.5 spacing 0.8 font ',8' noautotitle
set tmargin 1.5
set bmargin 1.5
of(form, solver) = stringcolumn('form') eq form && stringcolumn('solver') eq solver && stringcolumn('time_step_s') ne 'default'
error(form, solver) = of(form, solver) ? (column('error') > least ? column('error') : least) : NaN
# "p 1.07", where the table has an order of this curve
order(form, solver) = system("awk -F, '$1 == \"".form."\" && $2 == \"".solver."\" && $3 == \"all\" && $NF + 0 > 0 { printf \"p %.2g\", $NF }' '".table."'")
do for [f=1:words(forms)] {
  set title word(forms, f) noenhanced offset 0,-0.9 font ',10'
  plot word(goal, f) + 0 with lines linecolor rgb '#888888' dashtype 2, \
       for [s=1:3] table using 'step_s':(error(word(forms, f), word(solvers, s))) with linespoints linetype s pointsize 0.6 \
         title order(word(forms, f), word(solvers, s))
}
unset title
unset border
unset tics
unset logscale
unset grid
set key center center Left reverse
set xrange [0:1]
set yrange [0:1]
plot for [s=1:3] NaN with linespoints linetype s title word(solvers, s)
unset multiplot

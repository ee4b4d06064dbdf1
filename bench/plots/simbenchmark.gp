# needs: simbenchmark.csv
table = results.'/simbenchmark.csv'
scenes = '666 elastic_666 bouncing rolling'
engines = 'bin_scenes/sphere bin_scenes/bullet Bullet/bullet_stock RaiSim/bisection ODE/quick Bullet/multibody MuJoCo/Newton DART/Dantzig'
set multiplot layout 2,3 title 'SimBenchmark: error over CPU time; one point a time step (published times: other machine)'
set logscale xy
set format y '10^{%T}'
set format x '%g'
set xlabel 'CPU s' offset 0,0.7
unset key
error(scene, engine) = stringcolumn('scene') eq scene && stringcolumn('engine').'/'.stringcolumn('solver') eq engine && column('error') > 0 ? column('error') : NaN
unit(scene) = scene eq '666' ? 'm^2' : scene eq 'rolling' ? 'm^2/s^2' : 'J^2'
do for [s=1:words(scenes)] {
  set title word(scenes, s) noenhanced offset 0,-0.7
  set ylabel unit(word(scenes, s)) offset 1,0
  plot for [e=1:words(engines)] table using 'cpu_s':(error(word(scenes, s), word(engines, e))) with linespoints linetype e
}
unset title
unset border
unset tics
unset xlabel
unset ylabel
unset logscale
unset grid
set key center center Left reverse noenhanced
set xrange [0:1]
set yrange [0:1]
plot for [e=1:words(engines)] NaN with linespoints linetype e title word(engines, e)
unset multiplot

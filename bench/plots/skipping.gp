# needs: skipping.csv
set termoption noenhanced
table = results.'/skipping.csv'
array states = ['all awake', 'sleeping off', 'half awake', 'all asleep']
array solvers = ['sphere', 'bullet']
set title 'What sleep saves: a step of eight heaps of 16 parts'
set ylabel 'CPU ms a step'
set logscale y
set format y '%g'
set xrange [0.5:4.5]
set xtics ()
do for [i=1:4] { set xtics add (states[i] i) }
at(state) = sum [i=1:4] (states[i] eq state ? i : 0)
plot for [s=1:2] table using (at(strcol('state'))):(strcol('skip') eq 'sleeping' ? only('solver', solvers[s], 'step_cpu_ms') : NaN) \
  with points linetype s pointsize 1.6 title solvers[s]

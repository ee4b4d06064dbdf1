# needs: preparation.csv
set termoption noenhanced
table = results.'/preparation.csv'
set title 'Making a part ready: from file to first step. Large: cold, small: warm'
set logscale y
set format y '%g'
set ylabel 's'
parts = system("awk -F, '!/^#/ && $2 == \"bullet\" { printf \"%s \", $1 }' '".table."'")
set xtics rotate by -35 ()
do for [i=1:words(parts)] { set xtics add (word(parts, i) i) }
at(part) = sum [i=1:words(parts)] (word(parts, i) eq part ? i : 0)
set xrange [0.5:words(parts) + 0.5]
solvers = 'sphere bullet sphere/thesis'
plot for [s=1:3] table using (at(strcol('part'))):(only('solver', word(solvers, s), 'cold_s')) \
       with points linetype s pointsize 1.3 title word(solvers, s), \
     for [s=1:3] table using (at(strcol('part'))):(only('solver', word(solvers, s), 'warm_s')) \
       with points linetype s pointsize 0.6 notitle

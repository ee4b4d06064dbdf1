# needs: preparation.csv
table = results.'/preparation.csv'
set title 'Making a part ready: seconds from file to first step, by solver'
set style data linespoints
set logscale y
set format y '%g'
set ylabel 's'
set xtics rotate by -35
parts = system("awk -F, '!/^#/ && $2 == \"bullet\" { printf \"%s \", $1 }' '".table."'")
solvers = 'sphere bullet sphere/thesis'
set for [i=1:words(parts)] xtics add (word(parts, i) i)
at(part) = sum [i=1:words(parts)] (word(parts, i) eq part ? i : 0)
set xrange [0.5:words(parts) + 0.5]
plot for [s=1:3] table using (at(strcol('part'))):(only('solver', word(solvers, s), 'cold_s')) \
       with points linetype s title word(solvers, s).', cold', \
     for [s=1:3] table using (at(strcol('part'))):(only('solver', word(solvers, s), 'warm_s')) \
       with points linetype s pointsize 0.5 title word(solvers, s).', warm'

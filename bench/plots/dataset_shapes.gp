# needs: dataset_shapes.csv
# size: 900,760
set termoption noenhanced
table = results.'/dataset_shapes.csv'
shapes = system("awk -F, '!/^#/ && $1 != \"shape\" && !seen[$1]++ { printf \"%s \", $1 }' '".table."'")
set key inside left top
set multiplot layout 2, 1
set title 'Visible fraction: share of parts that are seen by at most so much'
set xrange [0:1]
set yrange [0:1]
set format y '%.1f'
# GraspClutter6D (arXiv 2504.06866), real bins, shelves and tables: 62.6 % of parts are visible by at most 95 %.
set label 1 'GraspClutter6D: 62.6 % at 0.95' at 0.94, 0.70 right
set label 2 '' at 0.95, 0.626 point pointtype 7 pointsize 1.5 linecolor rgb '#000000'
plot for [i=1:words(shapes)] table using (column('visible_from') + 0.05):(only('shape', word(shapes, i), 'visible_share')) \
  smooth cumulative with lines linetype i title word(shapes, i)
unset label 1
unset label 2
set title 'Tilt: angle between the z axes of model and bin; grey: orientations at random'
set xrange [0:180]
set yrange [0:*]
set format y '%.2f'
set xtics 30
set key inside right top
plot pi / 40 * sin(pi * x / 180) with lines linecolor rgb '#999999' dashtype 2 title 'at random', \
  for [i=1:words(shapes)] table using 'tilt_deg':(only('shape', word(shapes, i), 'tilt_share')) with linespoints linetype i title word(shapes, i)
unset multiplot

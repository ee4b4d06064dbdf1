# Shared by all figures: tables are read by column name; colours for the colour-blind (Okabe & Ito 2008).
set datafile separator ','
set datafile missing NaN
set datafile columnheaders
set key outside right top Left reverse samplen 2
set grid back linecolor rgb '#dddddd'
set border 3 linecolor rgb '#444444'
set tics nomirror
set linetype 1 linecolor rgb '#0072b2' linewidth 2 pointtype 7 pointsize 0.9
set linetype 2 linecolor rgb '#d55e00' linewidth 2 pointtype 5 pointsize 0.9
set linetype 3 linecolor rgb '#009e73' linewidth 2 pointtype 9 pointsize 1.0
set linetype 4 linecolor rgb '#cc79a7' linewidth 2 pointtype 11 pointsize 1.0
set linetype 5 linecolor rgb '#e69f00' linewidth 2 pointtype 13 pointsize 1.0
set linetype 6 linecolor rgb '#56b4e9' linewidth 2 pointtype 4 pointsize 0.9
set linetype 7 linecolor rgb '#000000' linewidth 2 pointtype 6 pointsize 0.9

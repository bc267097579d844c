# gnuplot -e "csv='scaling.csv'; folder='.'" plot_scaling.gp
set datafile separator ';'
set datafile missing NaN
set terminal pngcairo size 1500, 1500 font ',11'
set output folder.'/scaling.png'
set key top left
set grid
set logscale xy

axes = 'trees leaves samples outputs threads'
leaves = 'constant linear'
row(axis, leaf) = strcol(1) eq axis && strcol(3) eq leaf ? $2 : NaN

set multiplot layout 5, 2 title '25 trees, 2000 leaves, 50000 samples, 1 output, 1 thread, but for one of them'
do for [axis in axes] {
  set xlabel axis
  set ylabel 'training [s]'
  plot for [leaf in leaves] csv using (row(axis, leaf)):4 skip 1 with linespoints title leaf
  set ylabel 'ns per prediction'
  plot for [leaf in leaves] csv using (row(axis, leaf)):5 skip 1 with linespoints title leaf.', warm', \
       for [leaf in leaves] csv using (row(axis, leaf)):6 skip 1 with linespoints title leaf.', cold', \
       for [leaf in leaves] csv using (row(axis, leaf)):7 skip 1 with linespoints title leaf.', batch'
}
unset multiplot

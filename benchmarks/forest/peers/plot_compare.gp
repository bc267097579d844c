# gnuplot -e "csv='compare.csv'; folder='.'" plot_compare.gp
# From the table's CSV: times against leaves, and which error is had for how many bytes and how much time.
set datafile separator ';'
set datafile missing NaN
set terminal pngcairo size 1500, 1000 font ',11'
set grid
set logscale xy

names = "'surefoot constant' 'surefoot linear' 'surefoot constant, portable' 'surefoot distilled' 'dlib' 'OpenCV' 'XGBoost'"
array label[10] = ['', '', '', 'leaves per tree', 'training [CPU s]', 'test error, 1 - R2', \
                   'ns per prediction, warm', 'ns per prediction, cold', 'ns per prediction, batch', 'bytes']
cell(c) = c == 6 ? 1 - column(c) : column(c)
of(name, outputs, trees, c) = strcol(1) eq name && $2 == outputs && $11 == trees ? cell(c) : NaN
width(name) = strstrt(name, 'surefoot') > 0 ? 3 : 1.5

do for [outputs = 1:3:2] {
  do for [picture in "latency error"] {
    x_columns = picture eq 'latency' ? '4 4 4 4' : '10 7 8 5'
    y_columns = picture eq 'latency' ? '7 8 9 5' : '6 6 6 6'
    if (picture eq 'latency') { set key bottom right } else { set key top right }
    set output sprintf('%s/%s_%d.png', folder, picture, outputs)
    set multiplot layout 2, 2 title sprintf('%d output(s); dotted: 5 trees instead of 25', outputs)
    do for [panel = 1:4] {
      from = word(x_columns, panel) + 0
      to = word(y_columns, panel) + 0
      set xlabel label[from]
      set ylabel label[to]
      plot for [i = 1:words(names)] csv using (of(word(names, i), outputs, 25, from)):(cell(to)) skip 1 \
             with linespoints linetype i linewidth width(word(names, i)) title panel == 1 ? word(names, i) : '', \
           for [i = 1:words(names)] csv using (of(word(names, i), outputs, 5, from)):(cell(to)) skip 1 \
             with linespoints linetype i linewidth width(word(names, i)) dashtype 3 notitle
    }
    unset multiplot
  }
}

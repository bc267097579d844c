# gnuplot -e "csv='sizes.csv'; folder='.'; scripts='benchmarks/forest/peers'" plot_compare.gp
# latency_N.png: times against leaves, for N outputs. error_N.png: which error is had for how many bytes and how much
# time.
set datafile separator ';'
set datafile missing NaN
set terminal pngcairo size 1500, 1050 font ',12'
set grid linetype 1 linewidth 0.5 linecolor rgb '#cccccc'
set logscale xy
set format '10^{%T}'
set pointsize 0.8

array label[10] = ['', '', '', 'leaves per tree', 'training [CPU s]', '', 'ns per prediction, warm', \
                   'ns per prediction, cold', 'ns per prediction, batch', 'bytes']
array color[9] = ['#1f77b4', '#d62728', '#ff7f0e', '#8c1515', '#e377c2', '#555555', '#2ca02c', '#9467bd', '#17becf']
# One color, and one kind of points, for each name in both pictures.
all_names = "'surefoot constant' 'surefoot linear' 'surefoot pruned' 'surefoot distilled' 'surefoot one tree' 'dlib' \
             'OpenCV' 'XGBoost' 'surefoot constant, portable'"
look(name) = sum [i = 1:words(all_names)] (word(all_names, i) eq name ? i : 0)
width(name) = strstrt(name, 'surefoot') > 0 ? 2.5 : 1.5
others(outputs) = outputs == 1 ? "'dlib' 'OpenCV' 'XGBoost'" : "'dlib'"

of(name, outputs, trees, c) = strcol(1) eq name && $2 == outputs && $11 == trees ? column(c) : NaN
most_trees(name) = name eq 'surefoot distilled' ? 1 : 25

# Four panels above one line of names.
place(panel) = sprintf('set lmargin at screen %g; set rmargin at screen %g; set bmargin at screen %g; set tmargin at screen %g', \
                       panel % 2 == 1 ? 0.07 : 0.57, panel % 2 == 1 ? 0.48 : 0.98, panel < 3 ? 0.58 : 0.12, \
                       panel < 3 ? 0.94 : 0.48)
legend = 'set lmargin at screen 0.02; set rmargin at screen 0.98; set bmargin at screen 0.005; set tmargin at screen 0.055; \
          set key center center horizontal; unset border; unset tics; unset xlabel; unset ylabel; \
          set xrange [1:2]; set yrange [1:2]'
after_legend = 'unset multiplot; unset key; set border; set tics; set xrange [*:*]; set yrange [*:*]'
unset key

do for [outputs = 1:3:2] {
  set output sprintf('%s/latency_%d.png', folder, outputs)
  both = "'surefoot constant' 'surefoot constant, portable' 'surefoot linear' ".others(outputs)
  names = both." 'surefoot distilled'"
  set multiplot title sprintf('%d output%s; 25 trees, dotted: 5 (distilled: one)', outputs, outputs > 1 ? 's' : '')
  do for [panel = 1:4] {
    eval place(panel)
    to = word('7 8 9 5', panel) + 0
    set xlabel label[4]
    set ylabel label[to]
    plot for [name in names] csv using (of(name, outputs, most_trees(name), 4)):(column(to)) skip 1 \
           with linespoints linecolor rgb color[look(name)] pointtype look(name) linewidth width(name), \
         for [name in both] csv using (of(name, outputs, 5, 4)):(column(to)) skip 1 \
           with linespoints linecolor rgb color[look(name)] pointtype look(name) linewidth width(name) dashtype 3
  }
  eval legend
  plot for [name in names] NaN with linespoints linecolor rgb color[look(name)] pointtype look(name) \
         linewidth width(name) title name
  eval after_legend
}

set datafile separator whitespace
do for [outputs = 1:3:2] {
  set output sprintf('%s/error_%d.png', folder, outputs)
  names = "'surefoot constant' 'surefoot linear' 'surefoot pruned' 'surefoot distilled' 'surefoot one tree' ".others(outputs)
  set multiplot title sprintf('%d output%s; of all sizes, 1 to 25 trees, those that no other of the same kind beats', \
                              outputs, outputs > 1 ? 's' : '')
  do for [panel = 1:4] {
    eval place(panel)
    cost = word('10 7 8 9', panel) + 0
    set xlabel label[cost]
    set ylabel 'test error, 1 - R^2'
    plot for [name in names] \
           sprintf("< awk -F';' -v x=%d -v outputs=%d -v name='%s' -f '%s/best.awk' '%s'", cost, outputs, name, scripts, csv) \
           using 1:2 with linespoints linecolor rgb color[look(name)] pointtype look(name) linewidth width(name)
  }
  eval legend
  plot for [name in names] NaN with linespoints linecolor rgb color[look(name)] pointtype look(name) \
         linewidth width(name) title name
  eval after_legend
}

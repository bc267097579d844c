# Reliability diagram: gnuplot -e "data='reliability.dat'; picture='reliability.png'" reliability.gp
set terminal pngcairo size 640,640
set output picture
set xrange [0:1]
set yrange [0:1]
set xlabel "stated probability"
set ylabel "share right"
set key left top
set grid
plot x with lines lc rgb "#808080" title "perfectly calibrated", \
     data using 1:2:3 with yerrorbars pt 7 lc rgb "#c02020" title "stated structures", \
     data using 1:2:4 with labels offset 2,0.8 notitle

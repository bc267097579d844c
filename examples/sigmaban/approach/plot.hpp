// The frame of pictures of approaches: the ball at the origin, the kick along x, the grey zone to kick from.
#pragma once

namespace sigmaban {

/// Commands of gnuplot for every panel.
inline constexpr const char* approach_frame = R"(set size ratio -1
set xrange [-1.15:1.15]
set yrange [-1.15:1.15]
set xtics 0.5
set ytics 0.5
set grid lc rgb '#e6e6e6' lt 1
set key off
set xlabel 'towards the kick target [m]' offset 0,0.4
set ylabel 'left of it [m]' offset 1,0
set linetype 1 lc rgb '#0072b2' lw 1.3
set linetype 2 lc rgb '#d55e00' lw 1.3
set linetype 3 lc rgb '#009e73' lw 1.3
set linetype 4 lc rgb '#56b4e9' lw 1.3
set linetype 5 lc rgb '#e69f00' lw 1.3
set linetype 6 lc rgb '#cc79a7' lw 1.3
set object 1 circle at 0,0 size 0.07 fs solid fc rgb '#444444' front
set object 2 rectangle from -0.30,-0.06 to -0.15,0.06 fs solid 0.5 noborder fc rgb '#bbbbbb' behind
)";

}  // namespace sigmaban

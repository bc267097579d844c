# Which error is had for how much: of the CSV of forest_peers, by column x (10 bytes, 7 to 9 times), for so many outputs.
#   awk -F';' -v x=10 -v outputs=1 -v name=dlib -f best.awk sizes.csv     x and error of the forests of that name that
#                                                                          none of the same name beats in both
#   awk -F';' -v x=10 -v outputs=1 -f best.awk sizes.csv                  how many of those without linear leaves are
#                                                                          beaten by one with, and which are not
NR > 1 && $2 == outputs && (name == "" ? $1 !~ /portable/ : $1 == name) {
  ++all
  from[all] = $1
  cost[all] = $x + 0
  error[all] = 1 - $6
  size[all] = $11 " trees, " int($4 + 0.5) " leaves"
  linear[all] = $1 ~ /^surefoot (linear|pruned|distilled|one tree)/
}

function beaten(i, by_linear, j) {
  for (j = 1; j <= all; ++j) {
    if (by_linear && !linear[j]) continue
    if (cost[j] <= cost[i] && error[j] <= error[i] && (cost[j] < cost[i] || error[j] < error[i])) return 1
  }
  return 0
}

END {
  if (name != "") {
    if (all == 0) print "NaN NaN"
    for (i = 1; i <= all; ++i) {
      if (!beaten(i, 0)) print cost[i], error[i] | "sort -g"
    }
    exit
  }
  for (i = 1; i <= all; ++i) {
    if (linear[i]) continue
    ++others
    if (beaten(i, 1)) ++worse
    else printf "  not beaten: %s, %s: %g, error %.4f\n", from[i], size[i], cost[i], error[i]
  }
  printf "%d of %d\n", worse, others
}

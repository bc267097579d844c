#!/usr/bin/env bash
# Writes all of surefoot as one header: packaging/amalgamate.sh FILE, say surefoot.hpp. Compile with -std=c++20 and Eigen.
# Needs bash and awk. Each header comes once, after those it includes, and definitions (.ipp) after all headers; the same
# sources give the same file.
set -euo pipefail
if (($# != 1)); then
  echo "usage: packaging/amalgamate.sh FILE: the file to write, say surefoot.hpp" >&2
  exit 2
fi
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=$1
trap 'rm -f "$out.part"' EXIT

# take(header): appends it to `body` after what it includes; its definitions wait in `later`. Includes of the standard
# library and Eigen are collected, unless they stand behind a condition; those stay where they are.
LC_ALL=C awk -v include="$root/include" -v licence="$root/LICENSE" '
function take(header,    file, line, depth, text, name, status) {
  if (header in taken) return
  taken[header] = 1
  file = include "/" header
  while ((status = (getline line < file)) > 0) {
    if (line ~ /^#pragma once/) continue
    if (line ~ /^#ifndef SUREFOOT_COMPILED/) {  # the switch of a header: an include of its definitions (or of a header that has them), and #endif
      getline line < file
      if (line !~ /^#include ".*\.[hi]pp"/) fail(header ": SUREFOOT_COMPILED is for including definitions, not for: " line)
      split(line, name, "\"")
      later[++waiting] = name[2]
      getline line < file
      continue
    }
    if (line ~ /^[ \t]*#[ \t]*if/) ++depth
    if (line ~ /^[ \t]*#[ \t]*endif/) --depth
    if (line ~ /^#include "/) {
      if (depth > 0) fail(header ": " line " stands behind a condition, which one header cannot express")
      split(line, name, "\"")
      take(name[2])
    } else if (line ~ /^#include </ && depth == 0) {
      outside[line] = 1
    } else {
      text = text line "\n"
    }
  }
  if (status < 0) fail(file " cannot be read")
  close(file)
  gsub(/\n\n\n+/, "\n\n", text)
  body = body "\n// ---- " header "\n" text
}
function fail(why) {
  print "amalgamate: " why > "/dev/stderr"
  failed = 1
  exit 1
}
BEGIN {
  take("surefoot/surefoot.hpp")
  for (i = 1; i <= waiting; ++i) take(later[i])
  print "// All of surefoot in one header; needs C++20 and Eigen 3.4. Made by packaging/amalgamate.sh: change the headers that it"
  print "// was made from, not this one.\n//"
  while ((getline line < licence) > 0) print (line == "" ? "//" : "// " line)
  print "#pragma once\n"
  fflush()
  sorter = "sort"
  for (line in outside) print line | sorter
  close(sorter)
  printf "%s", body
}' >"$out.part"
mv "$out.part" "$out"

#!/usr/bin/env bash
# Writes the page of the manual of a program from its --version and --help: man_page.sh PROGRAM FILE.1.gz
# The help of each of its subcommands becomes a section.
set -euo pipefail
program=$1 page=$2
name=$(basename "$program")
version=$("$program" --version)
help=$("$program" --help)

# Text as it is: no backslash and no leading dot or quote means anything.
verbatim() {
  printf '.nf\n'
  sed -e 's/\\/\\e/g' -e 's/-/\\-/g' -e "s/^[.']/\\\\\&&/"
  printf '.fi\n'
}

mkdir -p "$(dirname "$page")"
{
  printf '.TH %s 1 "" "%s" "User commands"\n' "${name^^}" "$version"
  printf '.SH NAME\n%s \\- %s\n' "$name" "$(head -n 1 <<<"$help" | sed 's/^\(.\)/\l\1/')"
  printf '.SH USAGE\n'
  tail -n +2 <<<"$help" | sed "s|$program|$name|g" | verbatim
  # "Subcommands:", then two spaces, a name and what it does.
  for subcommand in $(awk '/^Subcommands:/ { on = 1; next } on && /^  [a-z]/ { print $1 } on && /^$/ { on = 0 }' <<<"$help"); do
    printf '.SH %s %s\n' "${name^^}" "${subcommand^^}"
    "$program" "$subcommand" --help | sed "s|$program|$name|g" | verbatim
  done
} | gzip -9n >"$page.part"
mv "$page.part" "$page"

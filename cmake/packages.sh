# shellcheck shell=bash
# Sourced by the run.sh scripts: makes sure that Debian packages are there.

# require_packages NAME...: installs what is missing as root or by sudo; else says what is missing and exits with 1.
require_packages() {
  local missing=() package run=()
  if ! command -v dpkg-query >/dev/null; then
    echo "surefoot: not a Debian system; the build needs what Debian calls: $*" >&2
    return
  fi
  for package in "$@"; do
    [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  if ((EUID != 0)); then
    if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
      run=(sudo)
    else
      echo "surefoot: missing packages; as root: apt-get install ${missing[*]}" >&2
      exit 1
    fi
  fi
  echo "surefoot: installing ${missing[*]}"
  "${run[@]}" apt-get update -qq || echo "surefoot: could not refresh the package lists, going on with the old ones" >&2
  "${run[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" || {
    echo "surefoot: could not install packages; needed: ${missing[*]}" >&2
    exit 1
  }
}

# What every program of ours is built with.
# shellcheck disable=SC2034
build_packages=(g++ cmake ninja-build libeigen3-dev libcli11-dev nlohmann-json3-dev libtoml11-dev)

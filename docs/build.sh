#!/usr/bin/env bash
# Builds the documentation site with the API reference, on a bare Debian 12, and checks every link of it. A dead link, a
# quote of lines that are gone, or a reference that Doxygen cannot follow ends it with an error and leaves the old site.
# The site goes to $SUREFOOT_SITE_DIR, by default build/site; open index.html there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PYTHONDONTWRITEBYTECODE=1
source cmake/packages.sh
require_packages mkdocs mkdocs-material python3-pymdownx doxygen

site=${SUREFOOT_SITE_DIR:-build/site}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

python3 docs/tools/quotes.py --check
mkdocs build --quiet --site-dir "$scratch/site"
version=$(sed -n 's/^project(surefoot VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
{
  cat docs/tools/Doxyfile
  echo "PROJECT_NUMBER = $version"
  echo "OUTPUT_DIRECTORY = $scratch/site"
} | doxygen -

echo "surefoot: checking links"
python3 docs/tools/check_links.py "$scratch/site"

mkdir -p "$(dirname "$site")"
rm -rf "$site.old"
[[ ! -e $site ]] || mv "$site" "$site.old"
mv "$scratch/site" "$site"
rm -rf "$site.old"
echo "surefoot: the site is $site/index.html"

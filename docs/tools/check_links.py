"""Checks every link of a site in a folder: each file and each anchor that a page names is there. Prints what is not,
and exits with 1. Links to other hosts are not followed, but no page may load anything from one.

python3 docs/tools/check_links.py FOLDER
"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """What a page names and which anchors it has."""

    def __init__(self, path):
        super().__init__()
        self.links, self.loads, self.anchors = [], [], {"", "top"}
        self.feed(path.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (name == "name" and tag in ("a", "map")):
                self.anchors.add(value)
            elif value and name in ("href", "src"):
                (self.links if tag == "a" or ("rel", "canonical") in attributes else self.loads).append(value)


def main(folder):
    root = pathlib.Path(folder).resolve()
    pages = {path: Page(path) for path in sorted(root.rglob("*.html"))}
    links, dead = 0, []
    for path, page in pages.items():
        foreign = [url for url in page.loads if urllib.parse.urlsplit(url).netloc]
        dead += [f"{path.relative_to(root)}: loads {url} from another host" for url in foreign]
        for url in set(page.links + page.loads):
            parts = urllib.parse.urlsplit(url)
            if parts.scheme or parts.netloc:
                continue
            links += 1
            base = root if parts.path.startswith("/") else path.parent
            target = (base / urllib.parse.unquote(parts.path).lstrip("/")).resolve() if parts.path else path
            if target.is_dir():
                target /= "index.html"
            if not target.is_file():
                dead.append(f"{path.relative_to(root)}: there is no {url}")
            elif parts.fragment == "nested-classes" and path.parent.name == "api":
                continue  # Doxygen links to a list of private classes that it leaves out
            elif target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                dead.append(f"{path.relative_to(root)}: {url} has no such anchor")
    print(f"{len(pages)} pages, {links} links, {len(dead)} dead")
    for complaint in dead:
        print("  " + complaint)
    return 1 if dead or not pages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))

"""Pictures of a report of surefoot-diagnose, as files of their own.

    python3 docs/tools/report_pictures.py [--check] REPORT FILE=TITLE ...

writes the picture with that title to FILE. --check: only compares FILE with it, by what is written in the picture; its
curves may differ by a pixel from one processor to the next.
"""

import html
import pathlib
import re
import sys


def pictures(report):
    text = pathlib.Path(report).read_text(encoding="utf-8")
    found = re.findall(r"<svg.*?</svg>", text, re.S)
    return {html.unescape(re.search(r"<title>(.*?)</title>", svg).group(1)): svg for svg in found}


def words(svg):
    return [text for text in re.findall(r"<text[^>]*>([^<]*)<", svg)]


def as_file(svg):
    """With a size and a ground, which the page of a report has and a file lacks."""
    width, height = re.search(r'viewBox="0 0 ([\d.]+) ([\d.]+)"', svg).groups()
    svg = re.sub(r' style="max-width:[^"]*"', "", svg, count=1)
    head = f'<svg width="{width}" height="{height}"'
    return svg.replace("<svg", head, 1).replace("</style>", '</style><rect width="100%" height="100%" fill="#fff"/>', 1) + "\n"


def main(arguments):
    check = arguments[:1] == ["--check"]
    report, *wanted = arguments[check:]
    drawn = pictures(report)
    faults = 0
    for one in wanted:
        file, title = one.split("=", 1)
        if title not in drawn:
            sys.exit(f"{report} has no picture '{title}', only {', '.join(drawn)}")
        if not check:
            pathlib.Path(file).write_text(as_file(drawn[title]), encoding="utf-8")
        elif words(pathlib.Path(file).read_text(encoding="utf-8")) != words(drawn[title]):
            print(f"{file} is out of date: make it again with docs/tools/report_pictures.py", file=sys.stderr)
            faults += 1
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

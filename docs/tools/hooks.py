"""What mkdocs does beyond Markdown: a page that lives outside of docs/, and links out of docs/, which become the name of
the file they lead to."""

import pathlib
import re

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[2]
OUTWARDS = re.compile(r"(?<!!)\[([^\]]+)\]\(\.\./([^)#]+)(#[^)]*)?\)")  # links from docs/ to files that are no pages
README_PAGES = ["examples/sigmaban/robot/README.md"]  # pages of the site that live elsewhere


def file_name_instead(found):
    text, target, anchor = found.groups()
    if not (ROOT / target).exists():
        raise PluginError(f"there is no file {target}, wanted by '{found.group(0)}'")
    if target in README_PAGES:
        return f"[{text}]({target}{anchor or ''})"
    return f"{text} (`{target}`)" if text.strip("`") != target else f"`{target}`"


def on_files(files, config):
    for file in [file for file in files if file.src_uri.startswith("tools/") or file.src_uri.endswith(".sh")]:
        files.remove(file)
    for page in README_PAGES:
        files.append(File(page, str(ROOT), config["site_dir"], config["use_directory_urls"]))
    return files


def on_page_markdown(markdown, page, **_):
    if page.file.src_uri in README_PAGES:
        return markdown.replace("../../../docs/", "../../../")
    return OUTWARDS.sub(file_name_instead, markdown)

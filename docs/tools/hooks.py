"""What mkdocs does beyond Markdown: quotes of compiled files and tables of options, made anew in each build.

A paragraph that is nothing but one of these links is replaced:

    [quote: name](../examples/guides/own_problem.cpp)   the lines between the two lines "// [name]" of that file
    [quote](../examples/minimal/main.cpp)               the whole file
    [options: RfpiOptions](../include/surefoot/...)     the fields of that struct: name, type, unit, default, meaning
    [fields: Diagnosis](../include/surefoot/...)        the same without defaults

Where pages are read elsewhere they are links to the file. Other links out of docs/ become the name of the file.
"""

import pathlib
import re
import sys

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import options_table  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
DIRECTIVE = re.compile(r"^\[(quote|options|fields)(?:: ([^\]]+))?\]\((?:\.\./)+([^)#]+)\)$", re.M)
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".c": "c", ".toml": "toml", ".sh": "sh", ".json": "json", ".txt": "cmake"}
OUTWARDS = re.compile(r"(?<!!)\[([^\]]+)\]\(\.\./([^)#]+)(#[^)]*)?\)")  # links from docs/ to files that are no pages
README_PAGES = ["examples/sigmaban_robot/README.md"]  # pages of the site that live elsewhere


def quoted(path, name):
    lines = path.read_text(encoding="utf-8").splitlines()
    if name:
        mark = f"// [{name}]"
        at = [i for i, line in enumerate(lines) if line.strip() == mark]
        if len(at) != 2:
            raise PluginError(f"{path}: needs two lines '{mark}' around what is quoted, has {len(at)}")
        lines = lines[at[0] + 1 : at[1]]
    lines = [line for line in lines if not re.fullmatch(r"\s*// \[\w+\]", line)]
    indent = min(len(line) - len(line.lstrip()) for line in lines if line.strip())
    return "\n".join(line[indent:] for line in lines).strip("\n")


def replacement(found):
    what, name, target = found.groups()
    path = ROOT / target
    if not path.is_file():
        raise PluginError(f"there is no file {target}, wanted by '{found.group(0)}'")
    if what == "quote":
        return f'```{LANGUAGES.get(path.suffix, "text")} title="{target}"\n{quoted(path, name)}\n```'
    return options_table.markdown(path, name, defaults=what == "options")


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
        return markdown.replace("../../docs/", "../../")
    return OUTWARDS.sub(file_name_instead, DIRECTIVE.sub(replacement, markdown))

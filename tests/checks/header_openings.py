"""Every header opens with a noun phrase that says what it holds: header_openings.py REPOSITORY

"Options of `diagnose()`.", not "What one can set" and not "Sets the options". The first word decides, and for words
that are noun and verb alike ("Plans", "Scores") the one after it.
"""
import re
import sys

from cpp_source import finish, headers

NO_NOUN = set("""
what who whom how where whether which why when whatever if all everything everyone one's nothing
from in on at for by with without of to into after before between beyond under over
it this that these those there here we you they
""".split())
VERBS = set("""
adds allocates applies asks attaches binds brings builds calibrates checks chooses computes converts copies counts
creates cuts decides describes detects divides drops evaluates explains fills finds fits follows gathers gives goes
grows holds integrates judges keeps knows lays learns lets loads locates looks makes measures merges moves names needs
picks plans predicts prepares proposes proves puts reads records removes replaces reports returns runs saves says scores
screens searches selects sends serves sets shows shrinks simulates solves sorts splits starts stops stores takes tells
tests throws trains tries tunes turns updates uses walks weighs works writes draws
""".split())
ALSO_NOUNS = {"plans", "scores", "walks", "fits", "tests", "records", "reports", "names", "checks", "measures", "splits",
              "updates", "uses", "works", "turns", "runs", "sets", "counts", "copies", "starts", "stops", "draws"}
DETERMINERS = {"a", "an", "the", "what", "how", "which", "where", "whether", "one", "every", "each", "all", "its", "them"}


def fault_of(words):
    first = words[0]
    second = words[1] if len(words) > 1 else ""
    if first in NO_NOUN:
        return f"opens with '{first}', no noun phrase"
    if first in VERBS and (first not in ALSO_NOUNS or second in DETERMINERS):
        return f"opens with the verb '{first}'"
    if first.endswith("s") and second in DETERMINERS:
        return f"opens with '{first} {second}', no noun phrase"
    return None


def check(root):
    faults = []
    for header, text in headers(root).items():
        opening = text.split("\n", 1)[0]
        words = [word.lower() for word in re.findall(r"[A-Za-z][\w'-]*|[^\w\s]", opening.removeprefix("//"))]
        if not opening.startswith("//") or not words:
            faults.append(f"include/{header}:1: does not open with a comment that says what it holds")
        elif fault := fault_of(words):
            faults.append(f"include/{header}:1: {fault}: {opening}")
    return faults


if __name__ == "__main__":
    finish("header_openings", check(sys.argv[1]), "every header opens with a noun phrase")

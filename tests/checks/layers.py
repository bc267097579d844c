"""Who may include whom in include/surefoot: layers.py REPOSITORY

Areas, each with those that it may include (core stands on Eigen alone); `solve` and `diagnose` never meet:
  core   forest: core   optimize: core   motion: core, optimize   solve: core, forest, optimize
  diagnose: core, forest, optimize   mpi: core
Headers directly in the folder of an area are its face. Folders below it are rooms, which other areas may not include.
Within an area a layer includes its own and those below, never one above or beside it. Faces named here stand between
rooms; in forest and motion the face includes rooms and rooms the face, in any order without a circle.
  diagnose   recording, simulator < effects < options, residual_model, diagnosis, text, screening < simulation
             < estimation < selection beside residual_tests, log_doctor < verdict < the rest of the face
  forest     evaluate < c, train < shrink
  motion     fit < monitor < changes < plan
NAME.ipp is a part of NAME.hpp, which alone includes it, at its end and unless SUREFOOT_COMPILED is defined.
The header of an area, surefoot/AREA.hpp, includes nothing but its face, all of it (itself, or through others of it; but
for headers that stand ON_THEIR_OWN), and headers of areas that it may use; surefoot/surefoot.hpp those of all areas and
all of their face. The library itself includes none of these. Headers of more than 300 lines are remarked on.
"""
import re
import sys

from cpp_source import finish, headers

MAY = {
    "core": [],
    "forest": ["core"],
    "optimize": ["core"],
    "motion": ["core", "optimize"],
    "solve": ["core", "forest", "optimize"],
    "diagnose": ["core", "forest", "optimize"],
    "mpi": ["core"],
}
OPTIONAL = ["mpi"]  # has no header of the area, and is not in surefoot.hpp

# Layers within an area from the bottom up: rooms, and headers of the face that stand between them; those of one line
# stand beside each other. "face" is what of it is not named.
LAYERS = {
    "diagnose": [["recording.hpp", "simulator.hpp"], ["effects"],
                 ["options.hpp", "residual_model.hpp", "diagnosis.hpp", "text.hpp", "screening.hpp"], ["simulation"],
                 ["estimation"], ["selection", "residual_tests", "log_doctor"], ["verdict"], ["face"]],
    "forest": [["evaluate"], ["c", "train"], ["shrink"]],
    "motion": [["fit"], ["monitor"], ["changes"], ["plan"]],
}

# Parts of the face that lie in a room, and headers of the folder that are no part of the face.
FACE_IN_ROOMS = ["surefoot/diagnose/effects/effect.hpp", "surefoot/diagnose/effects/catalogue.hpp",
                 "surefoot/diagnose/effects/named_effect.hpp"]
NO_FACE = ["surefoot/core/compiled.hpp",  # the switch between the two ways to build
           "surefoot/core/positive_definite.hpp", "surefoot/optimize/householder.hpp",
           "surefoot/optimize/linear_algebra.hpp", "surefoot/optimize/symmetric_eigen.hpp"]  # compiled once, for others
# Part of the face, but not in the header of their area: what they need costs other users too much to compile.
ON_THEIR_OWN = ["surefoot/core/validate.hpp", "surefoot/motion/walk_changes.hpp", "surefoot/solve/policy_search.hpp"]

# Beyond Eigen and the standard library.
SYSTEM_HEADERS = {
    "": ["immintrin.h"],  # intrinsics, behind the compiler's own macros
    "core": ["fcntl.h", "sys/stat.h", "unistd.h"],  # to flush files to the disk, behind the system's own macros
    "forest": ["smmintrin.h", "avxintrin.h", "avx2intrin.h",  # parts of immintrin.h
               "sys/mman.h"],  # to ask for large pages, behind the system's own macro
    "mpi": ["mpi.h", "pthread.h", "unistd.h"],
}
MOST_LINES = 300

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)


def area_of(header):
    parts = header.split("/")
    return parts[1] if len(parts) > 2 else None


def room_of(header):
    """The folder below the area, or None for a header of its folder."""
    parts = header.split("/")
    return parts[2] if len(parts) > 3 else None


def layer_of(header):
    """(height, name) among the layers of its area, or None where no order is set."""
    layers = LAYERS.get(area_of(header), [])
    room = room_of(header)
    names = [room] if room else [header.split("/")[-1].rsplit(".", 1)[0] + ".hpp", "face"]
    for name in names:
        for height, layer in enumerate(layers):
            if name in layer:
                return height, name
    return None


def is_face(header):
    return header.endswith(".hpp") and header not in NO_FACE and (room_of(header) is None or header in FACE_IN_ROOMS)


def includes(text):
    return [(match.group(1), match.group(2), text.count("\n", 0, match.start()) + 1)
            for match in INCLUDE.finditer(text)]


def own_part(header, target):
    """Whether one of both is NAME.hpp and the other NAME.ipp."""
    return header != target and header.rsplit(".", 1)[0] == target.rsplit(".", 1)[0]


def wrong_include(header, target):
    """Why `header` may not include `target`, or None."""
    area, other = area_of(header), area_of(target)
    if own_part(header, target):
        return None
    if target.endswith(".ipp"):
        return "only its own header may include it"
    if area != other:
        if other not in MAY[area]:
            return f"{area} may not include {other}"
        if room_of(target) and not is_face(target):
            return f"a room of {other}; only its face is for {area}"
        return None
    mine, its = layer_of(header), layer_of(target)
    if mine is None or its is None or mine == its:
        return None
    if its[0] > mine[0]:
        return f"{its[1]} lies above {mine[1]}"
    if its[0] == mine[0] and not (mine[1].endswith(".hpp") and its[1].endswith(".hpp")):  # the face may meet
        return f"{its[1]} lies beside {mine[1]}"
    return None


def seam_faults(header, text, files):
    """What is wrong with the seam between NAME.hpp and NAME.ipp."""
    name, suffix = header.rsplit(".", 1)
    if suffix == "ipp":
        if name + ".hpp" not in files:
            return [f"include/{header}:1: there is no {name}.hpp that it is a part of"]
        if f'#include "{name}.hpp"' not in text:
            return [f"include/{header}:1: does not include its own header"]
        return []
    ending = f'\n#ifndef SUREFOOT_COMPILED\n#include "{name}.ipp"\n#endif\n'
    if name + ".ipp" in files and not text.endswith(ending):
        return [f"include/{header}:{text.count(chr(10))}: must end with these three lines: {' / '.join(ending.split(chr(10))[1:-1])}"]
    return []


def in_a_circle(needs):
    """Takes away, again and again, what needs nothing that is left; returns the rest."""
    left = set(needs)
    while True:
        free = {name for name in left if not (needs[name] & left - {name})}
        if not free:
            return sorted(left)
        left -= free


def reached_from(header, files):
    """All headers that it includes, itself or through others, in a program that uses the compiled library."""
    reached, open_ends = set(), [header]
    while open_ends:
        for _, target, _ in includes(files[open_ends.pop()]):
            if target in files and target not in reached and not target.endswith(".ipp"):
                reached.add(target)
                open_ends.append(target)
    return reached


def expect_includes(header, files, wanted, allowed):
    """`header` reaches all that is wanted, and includes nothing itself that is neither wanted nor allowed."""
    if header not in files:
        return [f"include/{header}:1: is missing"]
    direct = {target for style, target, _ in includes(files[header]) if style == '"'}
    return ([f"include/{header}:1: does not include {target}"
             for target in sorted(set(wanted) - reached_from(header, files))] +
            [f"include/{header}:1: may not include {target}" for target in sorted(direct - set(wanted) - set(allowed))])


def check(root):
    files = headers(root)
    inner = {header: text for header, text in files.items() if area_of(header)}
    faults, needs = [], {}
    for header, text in inner.items():
        area = area_of(header)
        if area not in MAY:
            faults.append(f"include/{header}:1: there is no area {area}")
            continue
        room = room_of(header)
        if area in LAYERS and room and layer_of(header) is None:
            faults.append(f"include/{header}:1: there is no room {room} in {area}")
        name = header.rsplit(".", 1)[0]
        needs.setdefault(name, set())
        for style, target, line in includes(text):
            if style == "<":
                known = SYSTEM_HEADERS[""] + SYSTEM_HEADERS.get(area, [])
                if not re.fullmatch("[a-z_]+|Eigen/.*", target) and target not in known:
                    faults.append(f"include/{header}:{line}: <{target}> is neither Eigen nor the standard library")
            elif target not in inner:
                faults.append(f'include/{header}:{line}: "{target}" is not a header of an area, written from include/')
            else:
                if reason := wrong_include(header, target):
                    faults.append(f"include/{header}:{line}: may not include {target}: {reason}")
                if not own_part(header, target):
                    needs[name].add(target.rsplit(".", 1)[0])
        faults += seam_faults(header, text, files)
    circle = in_a_circle(needs)
    if circle:
        faults.append("include one another in a circle, or need one that does: " + ", ".join(circle))

    areas = [area for area in MAY if area not in OPTIONAL]
    alone = [header for header in ON_THEIR_OWN if header in files]
    for area in areas:
        face = [header for header in inner if area_of(header) == area and is_face(header)]
        faults += expect_includes(f"surefoot/{area}.hpp", files, set(face) - set(alone),
                                  face + [f"surefoot/{used}.hpp" for used in MAY[area]] +
                                  [header for header in alone if area_of(header) in MAY[area]])
    faults += expect_includes("surefoot/surefoot.hpp", files,
                              ["surefoot/version.hpp"] + [f"surefoot/{area}.hpp" for area in areas] + alone, [])
    return faults


def remarks(root):
    return [f"remark: {header} has {lines} lines; is it still one idea?" for header, text in headers(root).items()
            if (lines := text.count("\n")) > MOST_LINES]


if __name__ == "__main__":
    for remark in remarks(sys.argv[1]):
        print(remark)
    finish("layers", check(sys.argv[1]), f"{len(headers(sys.argv[1]))} headers keep their layers")

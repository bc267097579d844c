"""Measures what compiling costs; see run.sh."""
import argparse
import json
import os
import shlex
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = ["eigen", "forest", "solve", "motion", "diagnose"]
WAYS = {"headers": [], "compiled": ["-DSUREFOOT_COMPILED"]}
# What a program may cost [s of CPU time, MB], and a file of our own: a Raspberry Pi with 2 GB should do.
LIMITS = {("forest", "headers"): (6, 450), ("solve", "headers"): (12, 700), ("motion", "headers"): (15, 700),
          ("diagnose", "headers"): (30, 1100), ("motion", "compiled"): (5, 450), ("diagnose", "compiled"): (5, 450)}
FILE_LIMIT = (30, 1200)


def measure(command, folder=None):
    """Runs a command: seconds of CPU time and peak memory [MB] of the largest of its processes."""
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    process = subprocess.Popen(command, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True)
    errors = process.stderr.read()
    _, status, use = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{shlex.join(command)}\n{errors}")
    return use.ru_utime + use.ru_stime, use.ru_maxrss / 1024


def eigen_flags():
    if "EIGEN_INCLUDE" in os.environ:
        return ["-isystem", os.environ["EIGEN_INCLUDE"]]
    try:
        found = subprocess.run(["pkg-config", "--cflags", "eigen3"], capture_output=True, text=True, check=True).stdout
        return found.replace("-I", "-isystem ").split()
    except (OSError, subprocess.CalledProcessError):
        return ["-isystem", "/usr/include/eigen3"]


def compile_once(compiler, program, way, folder):
    """(seconds, MB, kB) of one compilation."""
    output = str(Path(folder) / f"{program}_{way}.o")
    seconds, megabytes = measure(compiler + ["-std=c++20", "-O2", f"-I{ROOT / 'include'}", *eigen_flags(), *WAYS[way],
                                             "-c", str(Path(__file__).parent / f"{program}.cpp"), "-o", output])
    return seconds, megabytes, os.stat(output).st_size / 1024


def measure_programs(compiler, repetitions, only):
    """Medians of (seconds, MB, kB) by program and way; repetitions in turn, so that what else runs hits all alike."""
    cases = [(program, way) for program in PROGRAMS for way in WAYS
             if (program != "eigen" or way == "headers") and (program in only or program == "eigen")]
    samples = {case: [] for case in cases}
    with tempfile.TemporaryDirectory() as folder:
        compile_once(compiler, "eigen", "headers", folder)  # reads the headers of Eigen into memory
        for repetition in range(repetitions):
            for case in cases:
                samples[case].append(compile_once(compiler, *case, folder))
                print(f"{repetition + 1}/{repetitions} {' '.join(case)}: {samples[case][-1][0]:.1f} s", file=sys.stderr)
    return {case: tuple(statistics.median(values) for values in zip(*of_case)) for case, of_case in samples.items()}


def program_table(found):
    unit = found["eigen", "headers"]
    lines = ["| program | way | CPU time | x Eigen | peak memory | x Eigen | object | x Eigen |",
             "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for (program, way), (seconds, megabytes, kilobytes) in found.items():
        label = {"headers": "headers alone", "compiled": "`surefoot::compiled`"}[way] if program != "eigen" else ""
        lines.append(f"| {program} | {label} | {seconds:.1f} s | {seconds / unit[0]:.1f} | {megabytes:.0f} MB | "
                     f"{megabytes / unit[1]:.1f} | {kilobytes:.0f} kB | {kilobytes / unit[2]:.1f} |")
    return lines


def over_limits(found):
    return [f"{program} ({way}): {found[program, way][0]:.1f} s, {found[program, way][1]:.0f} MB; "
            f"at most {limit[0]} s and {limit[1]} MB are wanted"
            for (program, way), limit in LIMITS.items() if (program, way) in found
            if found[program, way][0] > limit[0] or found[program, way][1] > limit[1]]


def own_command(entry):
    """The command of an entry of compile_commands.json, without ccache."""
    command = entry.get("arguments") or shlex.split(entry["command"])
    return command[1:] if Path(command[0]).name in ("ccache", "sccache") else command


def measure_files(build, pattern, jobs):
    """[(file, seconds, MB)] of every translation unit of our own build, the slowest first."""
    database = Path(build) / "compile_commands.json"
    if not database.exists():
        sys.exit(f"{database} is missing: cmake --preset release -B {build}, and build its precompiled headers")
    commands = {}  # of a file that several programs compile alike: one
    for entry in json.loads(database.read_text()):
        command = own_command(entry)
        output = command.index("-o") + 1
        if pattern in os.path.relpath(entry["file"], ROOT):
            commands[entry["file"], *command[:output], *command[output + 1:]] = (entry, command, output)

    def measure_file(case):
        entry, command, output = case
        name = os.path.relpath(entry["file"], ROOT)
        with tempfile.TemporaryDirectory() as folder:
            command[output] = str(Path(folder) / "out.o")
            seconds, megabytes = measure(command, entry["directory"])
        print(f"{name}: {seconds:.1f} s, {megabytes:.0f} MB", file=sys.stderr)
        return name, seconds, megabytes

    with ThreadPoolExecutor(jobs) as pool:
        return sorted(pool.map(measure_file, commands.values()), key=lambda row: -row[1])


def file_table(files):
    lines = ["| file | CPU time | peak memory |", "| --- | ---: | ---: |"]
    lines += [f"| `{name}` | {seconds:.1f} s | {megabytes:.0f} MB |" for name, seconds, megabytes in files]
    lines.append(f"| all {len(files)} | {sum(row[1] for row in files):.0f} s | "
                 f"{max((row[2] for row in files), default=0):.0f} MB |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default="build/release", help="folder of the build, for compile.json and --files")
    parser.add_argument("--repetitions", type=int, default=3, help="of every compilation; medians count (3)")
    parser.add_argument("--only", nargs="*", choices=PROGRAMS[1:], default=PROGRAMS[1:], help="these programs")
    parser.add_argument("--files", nargs="?", const="", metavar="TEXT",
                        help="measure also each file of the build (compile_commands.json) whose name contains TEXT")
    parser.add_argument("--jobs", type=int, default=2, help="files at a time; programs are compiled one by one (2)")
    options = parser.parse_args()
    compiler = shlex.split(os.environ.get("CXX", "g++"))

    found = measure_programs(compiler, options.repetitions, options.only)
    version = subprocess.run(compiler + ["--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
    print("\n".join(program_table(found)))
    print(f"\n{version}, -O2, median of {options.repetitions}")
    faults = over_limits(found)
    report = {"compiler": version, "repetitions": options.repetitions, "programs": [
        {"program": program, "way": way, "seconds": values[0], "megabytes": values[1], "object_kilobytes": values[2],
         "ratio_seconds": values[0] / found["eigen", "headers"][0],
         "ratio_megabytes": values[1] / found["eigen", "headers"][1],
         "ratio_object": values[2] / found["eigen", "headers"][2]} for (program, way), values in found.items()]}
    if options.files is not None:
        files = measure_files(options.build, options.files, options.jobs)
        print("\n" + "\n".join(file_table(files)))
        report["files"] = [{"file": name, "seconds": seconds, "megabytes": megabytes}
                           for name, seconds, megabytes in files]
        faults += [f"{name}: {seconds:.1f} s, {megabytes:.0f} MB; at most {FILE_LIMIT[0]} s and {FILE_LIMIT[1]} MB "
                   "are wanted" for name, seconds, megabytes in files
                   if seconds > FILE_LIMIT[0] or megabytes > FILE_LIMIT[1]]
    output = Path(options.build) / "compile.json"
    output.parent.mkdir(parents=True, exist_ok=True)
    output.write_text(json.dumps(report, indent=2) + "\n")
    print(f"\nwritten to {output}")
    for fault in faults:
        print(f"warning: {fault}")


if __name__ == "__main__":
    main()

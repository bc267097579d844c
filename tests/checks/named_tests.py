"""A test of its name for every header of the face and every stage of a diagnosis: named_tests.py REPOSITORY

tests/AREA/NAME_test.cpp for surefoot/AREA/NAME.hpp, tests/diagnose/ROOM/NAME_test.cpp for a header of a room; but for
the headers below, which another test covers because they are parts of what it tests.
"""
import sys
from pathlib import Path

from cpp_source import finish, headers
from layers import area_of, is_face, room_of

STAGES = ["simulation", "estimation", "log_doctor", "selection", "residual_tests", "verdict"]
COVERED = {
    "surefoot/diagnose/log_doctor/criteria.hpp": "diagnose/log_doctor/examine_log_test.cpp",  # thresholds
    "surefoot/diagnose/simulation/augmented_simulator.hpp": "diagnose/simulation/simulation_run_effects_test.cpp",
    "surefoot/diagnose/simulation/integrate.hpp": "diagnose/simulation/simulation_run_test.cpp",  # its order and steps
    "surefoot/diagnose/simulation/rates.hpp": "diagnose/simulation/simulation_run_effects_test.cpp",
    "surefoot/diagnose/simulation/step_updates.hpp": "diagnose/simulation/simulation_run_effects_test.cpp",
    "surefoot/motion/monitor.hpp": "motion/monitor/change_alarm_test.cpp",  # the names of three headers
    "surefoot/motion/plan.hpp": "motion/plan/command_plan_test.cpp",  # the names of three headers
    "surefoot/optimize/least_squares_loop.hpp": "optimize/least_squares_test.cpp",
    "surefoot/core/vec.hpp": "core/box_test.cpp",  # the names of two types
    "surefoot/optimize/cma_es_constants.hpp": "optimize/cma_es_core_test.cpp",
    "surefoot/optimize/cma_es_loop.hpp": "optimize/cma_es_test.cpp",
    "surefoot/optimize/cma_es_options.hpp": "optimize/cma_es_test.cpp",
    "surefoot/optimize/cma_es_search.hpp": "optimize/cma_es_serialize_test.cpp",
    "surefoot/optimize/cma_es_state.hpp": "optimize/cma_es_core_test.cpp",
    "surefoot/optimize/objective.hpp": "optimize/cma_es_test.cpp",
    "surefoot/solve/export_policy.hpp": "solve/forest_policy_test.cpp",
    "surefoot/solve/rfpi_backup.hpp": "solve/rfpi_test.cpp",
    "surefoot/solve/rfpi_options.hpp": "solve/rfpi_test.cpp",
    "surefoot/solve/rfpi_rollouts.hpp": "solve/rfpi_test.cpp",
    "surefoot/solve/rfpi_state.hpp": "solve/rfpi_test.cpp",
}


def check(root):
    faults = []
    for header in headers(root):
        area = area_of(header)
        stage = area == "diagnose" and room_of(header) in STAGES
        if header.endswith(".ipp") or not area or area == "mpi" or not (is_face(header) or stage):
            continue
        wanted = COVERED.get(header, header.removeprefix("surefoot/").removesuffix(".hpp") + "_test.cpp")
        if not (Path(root) / "tests" / wanted).exists():
            faults.append(f"include/{header}:1: there is no tests/{wanted}")
    return faults


if __name__ == "__main__":
    finish("named_tests", check(sys.argv[1]), "every header of the face and every stage has its test")

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the instructions of a step with about 40 contacts by callgrind, and compares the count with a bound and between
two meshes.

Usage: test_step_instructions.py STEP_INSTRUCTIONS     the program built from step_instructions.cpp

The count does not depend on the machine's speed or load, only on compiler and libraries. The bound is 1.5 times the
count in elastic, linear tissue with g++ 12 (0.74 million), since tissue that stiffens and creeps may cost more. The cost
of an iteration must not depend on the mesh; the number of iterations depends on the forces, which differ slightly
between meshes.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

MOST_PER_STEP = 1.11e6
MOST_FINE_OVER_COARSE = 1.5
MOST_FINE_OVER_COARSE_PER_ITERATION = 1.1
COARSE, FINE = 5, 10  # elements along the block's short edges
SKIPPED = 77


def count(program: str, cells: int) -> dict:
    # Old BLAS kernels, because valgrind runs newer ones far more slowly; BLAS is only used to prepare the tissue.
    environment = {**os.environ, "OPENBLAS_CORETYPE": "Core2", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--instr-atstart=no", "--collect-atstart=no",
                   f"--callgrind-out-file={Path(folder) / 'out'}", program, str(cells)]
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
    if done.returncode == SKIPPED:
        print("skipped: the program was built without valgrind's header valgrind/callgrind.h")
        sys.exit(SKIPPED)
    if done.returncode != 0:
        sys.exit(f"valgrind ended with {done.returncode}:\n{done.stderr}")
    result = json.loads(done.stdout)
    collected = re.search(r"Collected\s*:\s*(\d+)", done.stderr)
    if collected is None:
        sys.exit(f"valgrind says no count:\n{done.stderr}")
    result["per_step"] = int(collected.group(1)) / result["steps"]
    return result


def main() -> int:
    if shutil.which("valgrind") is None:
        print("skipped: valgrind is not installed")
        return SKIPPED
    coarse, fine = (count(sys.argv[1], cells) for cells in (COARSE, FINE))
    failed = []
    for mesh in (coarse, fine):
        print(f"{mesh['nodes']} nodes: {mesh['per_step'] / 1e6:.3f} million instructions a step, "
              f"{mesh['contacts']} contacts, {mesh['iterations'] / mesh['steps']:.2f} iterations")
        if mesh["flags"] != 0 or not 38 <= mesh["contacts"] <= 45:
            failed.append(f"the scene is not what it should be: flags {mesh['flags']}, contacts {mesh['contacts']}")
        if not 0 < mesh["per_step"] <= MOST_PER_STEP:
            failed.append(f"more than {MOST_PER_STEP / 1e6} million instructions a step")
    if fine["nodes"] < 5 * coarse["nodes"]:
        failed.append("the fine mesh is not finer")
    if fine["per_step"] > MOST_FINE_OVER_COARSE * coarse["per_step"]:
        failed.append(f"a step takes {fine['per_step'] / coarse['per_step']:.2f} times as many on the fine mesh")
    per_iteration = [mesh["per_step"] * mesh["steps"] / mesh["iterations"] for mesh in (coarse, fine)]
    if per_iteration[1] > MOST_FINE_OVER_COARSE_PER_ITERATION * per_iteration[0]:
        failed.append(f"an iteration takes {per_iteration[1] / per_iteration[0]:.2f} times as many on the fine mesh")
    print("\n".join(failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

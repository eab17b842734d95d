#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# From a fresh clone to a needle in the demo patient: installs what is missing, builds, runs.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"

echo "[1/3] Installing what is missing"
scripts/install_packages

echo "[2/3] Building the program into build/ (scripts/build builds tests, benchmarks and the C library as well)"
scripts/build release stylet_cli demo_model

echo "[3/3] Inserting a needle in the demo patient: stylet insert scenarios/demo.toml -o out/demo"
exec build/bin/stylet insert scenarios/demo.toml -o out/demo

#!/usr/bin/env python3
#SBATCH --array=0-11
#SBATCH --cpus-per-task=1
#SBATCH --time=00:10:00
"""The same landscapes as an array of jobs of Slurm, each of which writes its own place in the Zarr:

    python slurm_array.py create sweep.zarr
    sbatch slurm_array.py sweep.zarr

Slurm says in `SLURM_ARRAY_TASK_ID` which of them a job is; a job that failed is sent again by `sbatch --array=7`.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

# Slurm runs a copy of this file elsewhere.
sys.path.insert(0, os.environ.get("SLURM_SUBMIT_DIR", str(Path(__file__).parent)))

from sweep import create, run_case

if __name__ == "__main__":
    if sys.argv[1] == "create":
        create(sys.argv[2])
    else:
        run_case(sys.argv[1], int(os.environ["SLURM_ARRAY_TASK_ID"]))

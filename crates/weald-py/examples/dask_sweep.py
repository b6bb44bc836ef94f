"""Twelve landscapes on two workers of Dask, in one Zarr; a worker is killed half way.

    python dask_sweep.py sweep.zarr
"""

from __future__ import annotations

import os
import signal
import sys

from sweep import CASES, create, run_case


def main(path: str, kill: bool = True) -> None:
    from distributed import Client, LocalCluster, as_completed

    create(path)
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        client.upload_file(os.path.join(os.path.dirname(os.path.abspath(__file__)), "sweep.py"))
        victim = next(iter(client.run(os.getpid).values()))
        futures = client.map(run_case, [path] * len(CASES), range(len(CASES)), pure=False)
        for count, future in enumerate(as_completed(futures), start=1):
            print(f"{count} of {len(CASES)}: case {future.result()}", flush=True)
            if kill and count == len(CASES) // 2:
                os.kill(victim, signal.SIGKILL)  # its nanny starts another, and Dask gives it what was lost
    print("all are there")


if __name__ == "__main__":
    main(sys.argv[1])

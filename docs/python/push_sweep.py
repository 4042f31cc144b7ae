#!/usr/bin/env python3
"""Which pushes does the robot take? One line of CSV for each direction and impulse.

    python3 docs/python/push_sweep.py --impulses 6,12,18 --directions 0,90,180,270 > sweep.csv

Each push acts in a new world on a robot that steps in place, so that no push knows of another; the
simulation is stepped, so that the outcome does not depend on how fast this computer is.
"""

import argparse
import csv
import sys

from stagger_client import Stagger

TICKS_PER_S = 1000


def numbers(text):
    return [float(part) for part in text.split(",")]


def try_push(robot, seed, settle_s, observe_s, **push):
    """One push in a new world: (delivered [N s], fell or not, steps after it)."""
    robot.reset(seed=seed)
    robot.walk()
    robot.step(round(settle_s * TICKS_PER_S))
    steps = robot.state()["step_count"]
    record = robot.push(**push)
    robot.step(round(observe_s * TICKS_PER_S))
    state = robot.state()
    delivered = robot.find_push(record["id"])["delivered_ns"]
    return sum(x * x for x in delivered) ** 0.5, state["fallen"], state["step_count"] - steps


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--url", default="http://127.0.0.1:8080")
    parser.add_argument("--key", help="API key, where the server asks for one")
    parser.add_argument("--impulses", type=numbers, default=[6, 12, 18], help="[N s]")
    parser.add_argument("--directions", type=numbers, default=[0, 90, 180, 270], help="[degrees]")
    parser.add_argument("--duration", type=float, default=0.05, help="[s]")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--settle", type=float, default=3.0, help="before the push [s]")
    parser.add_argument("--observe", type=float, default=4.0, help="after it [s]")
    options = parser.parse_args()

    robot = Stagger(options.url, options.key, name="push_sweep")
    robot.pause()
    out = csv.writer(sys.stdout)
    out.writerow(["direction [deg]", "impulse [N s]", "delivered [N s]", "fell", "steps"])
    for direction in options.directions:
        for impulse in options.impulses:
            delivered, fell, steps = try_push(
                robot, options.seed, options.settle, options.observe,
                direction_deg=direction, impulse_ns=impulse, duration_s=options.duration)
            out.writerow([direction, impulse, round(delivered, 3), int(fell), steps])
            sys.stdout.flush()


if __name__ == "__main__":
    main()

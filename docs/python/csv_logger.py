#!/usr/bin/env python3
"""Writes the live stream to CSV until Ctrl-C, or for a time: one row a frame, units in the header.

    python3 docs/python/csv_logger.py --channels com,dcm,zmp --rate 100 --seconds 60 > walk.csv

Falls, pushes and the end of a session are told on standard error. A reset begins a new session: its
rows go on in the same file, with another session_id.
"""

import argparse
import csv
import sys

from stagger_client import Stagger


def columns(channel):
    """Names of the channel's values. Lists (footsteps, contacts) have no fixed number of them."""
    parts = channel["components"]
    for part in parts:
        name = channel["name"] + ("_" + part["name"] if part["name"] else "")
        yield f"{name} [{part['unit']}]" if part["unit"] else name


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--url", default="http://127.0.0.1:8080")
    parser.add_argument("--key", help="API key, where the server asks for one")
    parser.add_argument("--channels", default="com,dcm,zmp", help="names, separated by commas")
    parser.add_argument("--rate", type=float, default=60, help="frames a simulated second [Hz]")
    parser.add_argument("--seconds", type=float, help="of simulation time; without end otherwise")
    options = parser.parse_args()

    wanted = options.channels.split(",")
    out = csv.writer(sys.stdout)
    session = None
    start = None
    header = None
    for message in Stagger(options.url, options.key, name="csv_logger").stream(wanted, options.rate):
        kind = message["op"]
        if kind == "hello":
            session = message["session_id"]
            start = None
            known = {channel["name"]: channel for channel in message["channels"]}
            unfit = [name for name in wanted if known.get(name, {}).get("max_repeat") != 1]
            if unfit:
                sys.exit(f"no channels of a fixed size: {', '.join(unfit)}")
            row = ["session_id", "tick", "t [s]"]
            row += [name for channel in wanted for name in columns(known[channel])]
            if row != header:
                header = row
                out.writerow(header)
        elif kind == "data":
            start = message["t"] if start is None else start
            if options.seconds is not None and message["t"] - start > options.seconds:
                return
            values = [value for name in wanted for value in message["v"][name]]
            out.writerow([session, message["tick"], message["t"], *values])
        elif kind == "event" and message["kind"] != "step":
            print(f"{message['t']:.3f} s {message['kind']}: {message['text']}", file=sys.stderr)
        elif kind == "error":
            sys.exit(message["detail"])


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        pass

"""Questions that scripts put to the tyndall under test, as a user would: by its commands and their output."""

import csv
import io
import subprocess
import sys


def run(*command):
    """What the command prints; ends the script where it fails, so that no check passes on nothing."""
    done = subprocess.run([*map(str, command)], stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"exit code {done.returncode}: {' '.join(map(str, command))}")
    return done.stdout


def rows(text):
    """A CSV as a list of dictionaries."""
    return list(csv.DictReader(io.StringIO(text)))


def write_points(file, points):
    """Points of view for `sample` and `reference`: rows of altitude_m, mu_view, mu_sun, azimuth_deg."""
    file.write("altitude_m,mu_view,mu_sun,azimuth_deg\n")
    file.writelines(",".join(f"{v:.9g}" for v in point) + "\n" for point in points)
    file.flush()

"""What scripts need besides Python's packages, brought where the system lets them."""

import fcntl
import functools
import json
import shutil
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
THREE = "three@0.187.0"


def one_at_a_time(install):
    """Scripts run side by side; installers of one kind do not."""
    @functools.wraps(install)
    def locked(*arguments):
        with open(Path(tempfile.gettempdir()) / f"tyndall-{install.__name__}.lock", "w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            return install(*arguments)
    return locked


@one_at_a_time
def apt(*packages):
    """None where Debian's packages are installed, else why not."""
    if not shutil.which("apt-get"):
        return "no apt-get"
    sudo = ["sudo", "-n"] if shutil.which("sudo") else []
    apt_get = [*sudo, "apt-get", "-o", "DPkg::Lock::Timeout=300", "-o", "Acquire::Retries=5"]
    install = [*apt_get, "install", "-y", "--no-install-recommends", *packages]
    done = subprocess.run(install, capture_output=True, text=True)
    if done.returncode != 0:
        # The lists of a new machine are old, or not there.
        subprocess.run([*apt_get, "update"], capture_output=True)
        done = subprocess.run(install, capture_output=True, text=True)
    return None if done.returncode == 0 else (done.stderr.strip().splitlines() or ["no reason given"])[-1]


def program(name, *packages):
    """None where there is a program, else why its packages cannot be installed."""
    return None if shutil.which(name) else apt(*packages)


@one_at_a_time
def three():
    """The folder whose node_modules have three.js, which npm fetches the first time, or None with a line that says why."""
    home = ROOT / ".venv/node"
    if not (shutil.which("node") and shutil.which("npm")):
        print("three.js left out: there is no node and npm here")
        return None
    found = home / "node_modules/three/package.json"
    if not (found.exists() and json.loads(found.read_text())["version"] == THREE.split("@")[1]):
        home.mkdir(parents=True, exist_ok=True)
        patience = ["--fetch-retries", "5", "--fetch-timeout", "300000"]
        subprocess.run(["npm", "install", "--silent", "--no-save", *patience, "--prefix", home, THREE], check=True)
    return home

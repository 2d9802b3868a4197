"""Headless Chromium, as scripts ask it: a page in, its answer out."""

import json
import subprocess
import sys
import tempfile
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

from installing import program

CHROMIUM = ["--headless=new", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
            "--disable-background-networking", "--no-first-run", "--virtual-time-budget=600000", "--dump-dom"]


def install_chromium():
    """None where there is Chromium, else why there is none."""
    return program("chromium", "chromium")


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def answer_of(site):
    """What the page of a folder, served on the loopback, writes as JSON into its <pre id="answers">."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(site)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    url = f"http://127.0.0.1:{server.server_port}/index.html"
    # On a machine under load the page's time may run out before it has drawn: once more, then.
    for _ in range(3):
        with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
            done = subprocess.run(["chromium", *CHROMIUM, f"--user-data-dir={profile}", url],
                                  capture_output=True, text=True, timeout=900)
        if '<pre id="answers">' in done.stdout:
            break
    server.shutdown()
    if '<pre id="answers">' not in done.stdout:
        sys.exit(f"Chromium drew nothing: {done.stderr.strip()[-400:]}")
    text = done.stdout.split('<pre id="answers">')[1].split("</pre>")[0]
    answer = json.loads(text.replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))
    if "error" in answer:
        sys.exit(f"the client failed: {answer['error']}")
    return answer

"""Pages in headless Chromium, as a reader has them."""

import functools
import http.server
import json
import pathlib
import shutil
import subprocess
import tempfile
import threading

# A page that loads another into a frame (windows of browsers have a least width) and runs the body of a function of that frame.
DRIVER = """<!DOCTYPE html><iframe style="border:0"></iframe><script>
const frame = document.querySelector('iframe');
const show = (address, width, height) => new Promise(done => {
  frame.style.width = width + 'px'; frame.style.height = height + 'px'; frame.onload = () => done(frame.contentDocument); frame.src = address});
const until = async test => { for (let n = 0; n < 600; ++n) { const found = test(); if (found) return found; await new Promise(done => setTimeout(done, 50)) } };
(async () => { SCRIPT })().catch(error => ({error: String(error)})).then(seen => fetch('/seen', {method: 'POST', body: JSON.stringify(seen)}));
</script>"""


def chromium():
    """Path of the browser; None where it is not installed."""
    return shutil.which("chromium")


def seen(folder, script, timeout=100):
    """What a script returns that is shown pages of a folder, served over HTTP, in Chromium. Of use to it: `await show(address, width, height)`,
    the document of a page in a frame of so many pixels; `await until(() => ...)`, what a function gives as soon as it is something, or undefined
    after 30 s. TimeoutError when it does not end."""
    said, done = [], threading.Event()

    class Handler(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

        def do_GET(self):
            if self.path != "/driver":
                return super().do_GET()
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write(DRIVER.replace("SCRIPT", script).encode())

        def do_POST(self):
            said.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(200)
            self.end_headers()
            done.set()

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=str(pathlib.Path(folder))))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen([chromium(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--remote-debugging-port=0",
                                    f"--user-data-dir={profile}", f"http://127.0.0.1:{server.server_port}/driver"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # fmt: skip
        try:
            if not done.wait(timeout):
                raise TimeoutError(f"Chromium has not shown what was asked for in {timeout} s")
        finally:
            process.kill()
            process.wait()
            server.shutdown()
    return said[0]

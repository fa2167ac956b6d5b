"""Headless Chromium over the DevTools protocol: just what the tests of a page need."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import websocket

FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
)


COUNT_COLOURS = """
(async () => {
  const picture = new Image();
  picture.src = URL;
  await picture.decode();
  const canvas = document.createElement("canvas");
  canvas.width = picture.width;
  canvas.height = picture.height;
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  const data = context.getImageData(0, 0, picture.width, picture.height).data;
  return new Set(new Uint32Array(data.buffer)).size;
})()
"""


class Browser:
    """One tab, with everything it logs and asks for."""

    def __init__(self, address: str) -> None:
        self._socket = websocket.create_connection(address, timeout=120)
        self._number = 0
        self.complaints: list[str] = []
        self.requests: list[str] = []
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(f"{domain}.enable")

    def close(self) -> None:
        self._socket.close()

    def send(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command and wait for its answer; events that come between are kept."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self._socket.recv())
            if message.get("id") == self._number:
                assert "error" not in message, (method, message.get("error"))
                result: dict[str, Any] = message["result"]
                return result
            self._note(message)

    def evaluate(self, expression: str) -> Any:
        """Value of a JavaScript expression; a promise is waited for."""
        answer = self.send(
            "Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in answer, (expression, answer["exceptionDetails"])
        return answer["result"].get("value")

    def open(self, page: Path, width: int, height: int = 900, *, unfolded: bool = True) -> None:
        """Open a file in a window of the given size and wait until its plots are drawn.

        Its chapters are unfolded, unless the page is wanted as it comes.
        """
        self.visit(page.resolve().as_uri(), width, height)
        self.wait_for("document.documentElement.dataset.plots !== undefined")
        if unfolded:
            self.unfold()

    def visit(self, url: str, width: int, height: int = 900) -> None:
        """Open any page in a window of the given size and wait until it is loaded."""
        self.complaints.clear()
        self.requests.clear()
        self.resize(width, height)
        answer = self.send("Page.navigate", url=url)
        assert "errorText" not in answer, (url, answer["errorText"])
        # the old document answers until the new one has begun
        here = f"location.href === {json.dumps(url)}"
        self.wait_for(f"{here} && document.readyState === 'complete'")

    def unfold(self) -> None:
        """Open all chapters and wait until their plots are drawn."""
        self.evaluate("document.querySelector('.unfold button')?.click()")
        self.wait_for("!document.documentElement.dataset.plots.includes('folded')")

    def draw(self, selector: str) -> None:
        """Open the chapter of an element of a folded page and wait until its plots are drawn."""
        self.evaluate(
            f"(() => {{ const chapter = document.querySelector({json.dumps(selector)})"
            ".closest('details:not([open])'); if (!chapter) return;"
            " delete document.documentElement.dataset.plots; chapter.open = true; })()"
        )
        self.wait_for("document.documentElement.dataset.plots !== undefined")

    def resize(self, width: int, height: int) -> None:
        self.send(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def wait_for(self, condition: str, seconds: float = 120.0) -> None:
        limit = time.monotonic() + seconds
        while time.monotonic() < limit:
            if self.evaluate(condition):
                return
            time.sleep(0.1)
        raise AssertionError(f"{condition} did not come true; the console said {self.complaints}")

    def screenshot(self, **parameters: Any) -> bytes:
        """PNG of the window, or of a part of the page given as `clip`."""
        answer = self.send("Page.captureScreenshot", format="png", **parameters)
        return base64.b64decode(answer["data"])

    def colours(self, selector: str) -> int:
        """How many colours an element shows on the screen."""
        box = self.evaluate(
            f"(() => {{ const box = document.querySelector({json.dumps(selector)})"
            ".getBoundingClientRect(); return { x: box.x + scrollX, y: box.y + scrollY,"
            " width: box.width, height: box.height }; })()"
        )
        picture = self.screenshot(clip=box | {"scale": 1}, captureBeyondViewport=True)
        url = json.dumps("data:image/png;base64," + base64.b64encode(picture).decode())
        number: int = self.evaluate(COUNT_COLOURS.replace("URL", url))
        return number

    @property
    def network(self) -> list[str]:
        """Addresses asked for that are neither files nor in the page itself."""
        return [
            url for url in self.requests if urlsplit(url).scheme not in ("file", "data", "blob")
        ]

    def _note(self, message: dict[str, Any]) -> None:
        method, values = message.get("method"), message.get("params", {})
        if method == "Network.requestWillBeSent":
            self.requests.append(values["request"]["url"])
        elif method == "Network.webSocketCreated":
            self.requests.append(values["url"])
        elif method == "Runtime.exceptionThrown":
            self.complaints.append(json.dumps(values["exceptionDetails"]))
        elif method == "Runtime.consoleAPICalled" and values["type"] in ("error", "assert"):
            self.complaints.append(json.dumps(values["args"]))
        elif method == "Log.entryAdded" and values["entry"]["level"] == "error":
            self.complaints.append(json.dumps(values["entry"]))


@contextmanager
def chromium() -> Iterator[Browser]:
    """A browser of its own, with an empty profile, gone at the end."""
    program = shutil.which("chromium")
    assert program, "Chromium is missing: the reports are tested in it. apt-get install chromium"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        process = subprocess.Popen(
            [program, *FLAGS, f"--user-data-dir={profile}", "about:blank"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            browser = Browser(_tab(_port(Path(profile), process)))
            yield browser
            browser.close()
        finally:
            process.terminate()
            process.wait(timeout=30)


def _port(profile: Path, process: subprocess.Popen[bytes]) -> int:
    """The port that Chromium chose and wrote down."""
    limit = time.monotonic() + 60.0
    file = profile / "DevToolsActivePort"
    while time.monotonic() < limit:
        assert process.poll() is None, f"Chromium ended with status {process.returncode}"
        lines = file.read_text(encoding="ascii").splitlines() if file.exists() else []
        if len(lines) == 2:
            return int(lines[0])
        time.sleep(0.05)
    raise AssertionError("Chromium did not open its DevTools port in a minute")


def _tab(port: int) -> str:
    """Address of the first tab's DevTools socket."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list", timeout=60) as answer:
        tabs = json.load(answer)
    address: str = next(t["webSocketDebuggerUrl"] for t in tabs if t["type"] == "page")
    return address

"""A report's page as a PDF, printed by a browser of the system: Chrome, Chromium, Edge or Brave.

Choreographer, the extra `pdf`, finds the browser and speaks with it; nothing is downloaded.
"""

from __future__ import annotations

import asyncio
import base64
import logging
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from strutwork.errors import ModelError, NumericalError
from strutwork.names import visible

#: Name of the PDF in the folder of a report.
PDF = "report.pdf"

#: Longest time for one step of a browser, s: pictures of 3-D views are drawn in software.
PATIENCE = 300.0

#: The page says when its script has run.
_LOADED = """
new Promise((done) => {
  const look = () => (window.paper && document.documentElement.dataset.plots !== undefined
    ? done(true) : setTimeout(look, 50));
  look();
})
"""


def require_browser() -> Path:
    """The browser that prints, before minutes of work and not after them.

    Returns
    -------
    Path
        The program that `BROWSER_PATH` names, else the first of the known ones on the system.

    Raises
    ------
    ModelError
        The extra is not installed, or there is no browser.
    """
    if find_spec("choreographer") is None:
        raise ModelError(
            "report --pdf",
            "needs the library choreographer, which is not installed.",
            "Install the extra: pip install strutwork[pdf]; or open the page and print it.",
        )
    from choreographer.browsers.chromium import Chromium

    found = Chromium.find_browser(skip_local=False)
    if not found or not Path(found).is_file():
        what = "none is installed" if not found else f"{visible(str(found))} is not a program"
        raise ModelError(
            "report --pdf",
            f"needs Chrome, Chromium, Edge or Brave to print with, and {what}.",
            "Install one, for example with apt install chromium, or set BROWSER_PATH to its "
            "program; or open the page in another browser and print it.",
        )
    return Path(found)


def print_page(page: Path, path: Path) -> Path:
    """Print a page with all its plots.

    Parameters
    ----------
    page : Path
        Written by `strutwork.reports.build.write_page`.
    path : Path
        The PDF.

    Raises
    ------
    ModelError
        As `require_browser`, or a browser that does not start.
    NumericalError
        A page whose plots cannot be drawn, or that takes longer than `PATIENCE`.
    """
    program = require_browser()
    from choreographer.browsers import BrowserClosedError, BrowserFailedError
    from choreographer.channels import ChannelClosedError

    # what a browser says of itself is of no use to who waits for a report
    logging.getLogger("choreographer").setLevel(logging.ERROR)
    logging.getLogger("browser_proc").setLevel(logging.CRITICAL)
    try:
        content = asyncio.run(_printed(program, page))
    except (BrowserClosedError, BrowserFailedError, ChannelClosedError, OSError) as error:
        raise ModelError(
            "report --pdf",
            f"{program} does not start, or ended early ({type(error).__name__}).",
            "Try it at the terminal, or set BROWSER_PATH to another browser.",
        ) from error
    except TimeoutError:
        raise NumericalError(
            str(page),
            f"was not drawn within {PATIENCE:.0f} s.",
            "Open it in a browser and print it.",
        ) from None
    path.write_bytes(content)
    return path


async def _printed(program: Path, page: Path) -> bytes:
    from choreographer import Browser

    async with Browser(path=program, enable_extensions=False) as browser:
        tab = browser.get_tab()
        if tab is None:
            raise OSError("the browser shows no page")

        async def send(method: str, **parameters: Any) -> dict[str, Any]:
            sent = tab.send_command(method, params=parameters)
            answer = await asyncio.wait_for(sent, PATIENCE)
            if "error" in answer:
                raise OSError(f"{method}: {answer['error'].get('message', '')}")
            result: dict[str, Any] = answer["result"]
            return result

        async def evaluate(expression: str) -> Any:
            answer = await send(
                "Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True
            )
            return answer["result"].get("value")

        await send("Page.navigate", url=page.resolve().as_uri())
        await evaluate(_LOADED)
        failed = await evaluate("window.paper.prepare()")
        if failed:
            raise NumericalError(
                str(page),
                f"has plots that this browser cannot draw: {', '.join(map(str, failed))}.",
                "Open it in a browser and print it.",
            )
        answer = await send(
            "Page.printToPDF",
            preferCSSPageSize=True,
            printBackground=True,
            generateTaggedPDF=True,
            generateDocumentOutline=True,
        )
        return base64.b64decode(answer["data"])

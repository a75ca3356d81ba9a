"""The routes of the live view."""

import sys
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import anyio
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket

from lumitip.errors import LumitipError, ViewError
from lumitip.view.finger import Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.session import Session

STATIC = Path(__file__).parent / "static"
_MOST_BROWSERS = 32
_FULL = f"{_MOST_BROWSERS} pages of the live view are open, the most allowed. Close one of them.\n"
_DIGITS = 10

Answer = Callable[[FingerRegistry, dict[str, Any], Request], Awaitable[dict[str, Any]]]


def make_app(registry: FingerRegistry) -> Starlette:
    """The web application, without access control: see `Guard`."""

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        import asyncio

        registry.open(asyncio.get_running_loop())
        try:
            yield
        finally:
            await anyio.to_thread.run_sync(registry.close)

    browsers = set[WebSocket]()

    async def stream(websocket: WebSocket) -> None:
        if len(browsers) >= _MOST_BROWSERS:
            await websocket.close(1013)  # the browser asks the next route why
            return
        await websocket.accept()
        browsers.add(websocket)
        try:
            await Session(websocket, registry).run()
        finally:
            browsers.discard(websocket)

    async def stream_refusal(_: Request) -> Response:
        full = len(browsers) >= _MOST_BROWSERS
        return PlainTextResponse(_FULL, 503) if full else Response(status_code=204)

    async def fingers(_: Request) -> Response:
        return JSONResponse(registry.describe())

    async def recordings(_: Request) -> Response:
        return JSONResponse(await anyio.to_thread.run_sync(registry.recordings))

    async def download(request: Request) -> Response:
        name: str = request.path_params["name"]
        try:
            path = await anyio.to_thread.run_sync(registry.finished, name)
        except ViewError as error:
            return JSONResponse({"error": str(error)}, 404)
        return FileResponse(path, filename=path.name, media_type="application/octet-stream")

    return Starlette(
        routes=[
            WebSocketRoute("/stream", stream),
            Route("/stream", stream_refusal),
            Route("/api/fingers", fingers),
            Route("/api/recordings", recordings),
            Route("/api/recordings/{name}", download),
            _post("/api/fingers/{number}/tare", registry, _tare),
            _post("/api/fingers/{number}/record", registry, _record),
            _post("/api/fingers/{number}/close", registry, _close),
            _post("/api/fingers/{number}/player", registry, _player),
            _post("/api/fingers/{number}/scene", registry, _scene),
            _post("/api/replay", registry, _replay),
            Mount("/", StaticFiles(directory=STATIC, html=True)),
        ],
        lifespan=lifespan,
    )


def _post(path: str, registry: FingerRegistry, answer: Answer) -> Route:
    """A route that takes a JSON object; errors are `{"error": …}`."""

    async def handle(request: Request) -> Response:
        try:
            body = await request.json()
        except (ValueError, RecursionError):
            body = None
        if not isinstance(body, dict):
            return JSONResponse({"error": "a JSON object is needed"}, 400)
        try:
            return JSONResponse(await answer(registry, body, request))
        except (LumitipError, OSError) as error:
            return JSONResponse({"error": str(error)}, 409)

    return Route(path, handle, methods=["POST"])


def _finger(registry: FingerRegistry, request: Request) -> tuple[int, Finger]:
    text: str = request.path_params["number"]
    if not (text.isascii() and text.isdecimal() and len(text) < _DIGITS):
        raise HTTPException(404)
    number = int(text)
    if number not in registry.fingers:
        raise ViewError(f"finger {number} is closed")
    return number, registry.fingers[number]


def _needs_device(finger: Finger) -> None:
    if finger.player:
        raise ViewError(f"{finger.url} is a replay; only a device can be tared or recorded")


async def _tare(registry: FingerRegistry, body: dict[str, Any], request: Request) -> dict[str, Any]:
    """`{"kind": "empty" | "dark"}`"""
    _, finger = _finger(registry, request)
    _needs_device(finger)
    kind = body.get("kind", "empty")
    if kind not in ("empty", "dark"):
        raise ViewError(f"kind is {kind!r}; allowed are empty and dark")
    await anyio.to_thread.run_sync(finger.tare, kind)
    return {"said": f"{finger.tip.device_id}: tared, {kind} reference"}


async def _record(
    registry: FingerRegistry, body: dict[str, Any], request: Request
) -> dict[str, Any]:
    """`{"on": true | false}`"""
    _, finger = _finger(registry, request)
    on = body.get("on")
    if type(on) is not bool:
        raise ViewError(f"on is {on!r:.40}; true or false is needed")
    if on:
        _needs_device(finger)
        path = await anyio.to_thread.run_sync(registry.fresh, finger)
        await anyio.to_thread.run_sync(finger.record, path)
        return {"said": f"recording to {path.name}", "file": path.name}
    done = await anyio.to_thread.run_sync(finger.stop_recording)
    return {"said": f"{done.name} written" if done else "", "file": done.name if done else None}


async def _close(registry: FingerRegistry, _: dict[str, Any], request: Request) -> dict[str, Any]:
    number, finger = _finger(registry, request)
    if finger.player is None:
        raise ViewError(f"{finger.tip.device_id} is live; only a replay can be closed from here")
    await anyio.to_thread.run_sync(registry.remove, number)
    return {"said": f"{finger.tip.device_id} closed"}


async def _player(
    registry: FingerRegistry, body: dict[str, Any], request: Request
) -> dict[str, Any]:
    """`{"playing": true, "position_s": 2.5, "speed": 0.5}`, all optional"""
    _, finger = _finger(registry, request)
    if finger.player is None:
        raise ViewError(f"{finger.tip.device_id} is live; only a replay has a position")
    playing = body.get("playing")
    if playing not in (None, True, False):
        raise ViewError(f"playing is {playing!r}; true or false is needed")
    finger.player.control(playing, _number(body, "position_s"), _number(body, "speed"))
    return {}


async def _scene(
    registry: FingerRegistry, body: dict[str, Any], request: Request
) -> dict[str, Any]:
    """`{"object": "edge", "offset_mm": 2.0, "angle_deg": 80.0}`, see `Placeable.place`"""
    _, finger = _finger(registry, request)
    if finger.tip.simulated is None:
        raise ViewError(f"{finger.url} is not simulated; only the object of a twin:// can be moved")
    finger.tip.simulated.place(body)
    placed = finger.tip.simulated.placement()["values"]
    if "diameter_mm" in placed:
        finger.estimates.expect(placed["diameter_mm"])
    return {}


def _number(body: dict[str, Any], name: str) -> float | None:
    value = body.get(name)
    if value is None:
        return None
    if type(value) not in (int, float) or not abs(value) <= sys.float_info.max:
        raise ViewError(f"{name} is {value!r:.40}; a number is needed")
    return float(value)


async def _replay(registry: FingerRegistry, body: dict[str, Any], _: Request) -> dict[str, Any]:
    """`{"name": "run.mcap"}`, a recording in the folder"""
    name = str(body.get("name"))
    number = await anyio.to_thread.run_sync(registry.replay, name)
    return {"said": f"replaying {name}", "number": number}

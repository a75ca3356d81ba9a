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
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket

from lumitip.errors import LumitipError, ViewError
from lumitip.view.finger import Finger
from lumitip.view.room import Room
from lumitip.view.session import Session

STATIC = Path(__file__).parent / "static"
_MOST_BROWSERS = 32
_DIGITS = 10

Answer = Callable[[Room, dict[str, Any], Request], Awaitable[dict[str, Any]]]


def make_app(room: Room) -> Starlette:
    """The live view of a room, not guarded: `Guard` goes in front of it."""

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncIterator[None]:
        import asyncio

        room.open(asyncio.get_running_loop())
        try:
            yield
        finally:
            await anyio.to_thread.run_sync(room.close)

    browsers = set[WebSocket]()

    async def stream(websocket: WebSocket) -> None:
        if len(browsers) >= _MOST_BROWSERS:
            await websocket.close(1013)
            return
        await websocket.accept()
        browsers.add(websocket)
        try:
            await Session(websocket, room).run()
        finally:
            browsers.discard(websocket)

    async def fingers(_: Request) -> Response:
        return JSONResponse(room.describe())

    async def recordings(_: Request) -> Response:
        return JSONResponse(await anyio.to_thread.run_sync(room.recordings))

    return Starlette(
        routes=[
            WebSocketRoute("/stream", stream),
            Route("/api/fingers", fingers),
            Route("/api/recordings", recordings),
            _post("/api/fingers/{number}/tare", room, _tare),
            _post("/api/fingers/{number}/record", room, _record),
            _post("/api/fingers/{number}/close", room, _close),
            _post("/api/fingers/{number}/player", room, _player),
            _post("/api/replay", room, _replay),
            Mount("/", StaticFiles(directory=STATIC, html=True)),
        ],
        lifespan=lifespan,
    )


def _post(path: str, room: Room, answer: Answer) -> Route:
    """A route that takes a JSON object and says what went wrong as `{"error": …}`."""

    async def handle(request: Request) -> Response:
        try:
            told = await request.json()
        except (ValueError, RecursionError):
            told = None
        if not isinstance(told, dict):
            return JSONResponse({"error": "a JSON object is needed"}, 400)
        try:
            return JSONResponse(await answer(room, told, request))
        except (LumitipError, OSError) as error:
            return JSONResponse({"error": str(error)}, 409)

    return Route(path, handle, methods=["POST"])


def _finger(room: Room, request: Request) -> tuple[int, Finger]:
    text: str = request.path_params["number"]
    if not (text.isascii() and text.isdecimal() and len(text) < _DIGITS):
        raise HTTPException(404)
    number = int(text)
    if number not in room.fingers:
        raise ViewError(f"finger {number} is not shown any more")
    return number, room.fingers[number]


def _needs_device(finger: Finger) -> None:
    if finger.player:
        raise ViewError(f"{finger.url} is a replay: only a device can be tared or recorded")


async def _tare(room: Room, told: dict[str, Any], request: Request) -> dict[str, Any]:
    """`{"kind": "empty" | "dark"}`"""
    _, finger = _finger(room, request)
    _needs_device(finger)
    kind = told.get("kind", "empty")
    if kind not in ("empty", "dark"):
        raise ViewError(f"kind: {kind!r} given, allowed are empty and dark")
    await anyio.to_thread.run_sync(finger.tip.tare, kind)
    return {"said": f"{finger.tip.device_id}: tared, {kind} reference"}


async def _record(room: Room, told: dict[str, Any], request: Request) -> dict[str, Any]:
    """`{"on": true | false}`"""
    _, finger = _finger(room, request)
    if told.get("on") is True:
        _needs_device(finger)
        path = await anyio.to_thread.run_sync(room.fresh, finger)
        await anyio.to_thread.run_sync(finger.record, path)
        return {"said": f"recording to {path.name}", "file": path.name}
    done = await anyio.to_thread.run_sync(finger.stop_recording)
    return {"said": f"{done.name} written" if done else "", "file": done.name if done else None}


async def _close(room: Room, _: dict[str, Any], request: Request) -> dict[str, Any]:
    number, finger = _finger(room, request)
    await anyio.to_thread.run_sync(room.remove, number)
    return {"said": f"{finger.tip.device_id} closed"}


async def _player(room: Room, told: dict[str, Any], request: Request) -> dict[str, Any]:
    """`{"playing": true, "position_s": 2.5, "speed": 0.5}`, each if it is to change"""
    _, finger = _finger(room, request)
    if finger.player is None:
        raise ViewError(f"{finger.tip.device_id} is live: only a replay can be wound")
    playing = told.get("playing")
    if playing not in (None, True, False):
        raise ViewError(f"playing: {playing!r} given, true or false is needed")
    finger.player.control(playing, _number(told, "position_s"), _number(told, "speed"))
    return {}


def _number(told: dict[str, Any], name: str) -> float | None:
    value = told.get(name)
    if value is None:
        return None
    if type(value) not in (int, float) or not abs(value) <= sys.float_info.max:
        raise ViewError(f"{name}: {value!r:.40} given, a number is needed")
    return float(value)


async def _replay(room: Room, told: dict[str, Any], _: Request) -> dict[str, Any]:
    """`{"name": "run.mcap"}`, a recording of the folder"""
    from lumitip.view.player import Player

    path = room.recording(str(told.get("name")))
    player = await anyio.to_thread.run_sync(Player, path)
    finger = await anyio.to_thread.run_sync(Finger.play, path.name, player)
    return {"said": f"replaying {path.name}", "number": room.add(finger)}

"""The lifecycle node `fingertip`.

Configured, it is connected; active, it publishes the frames, and only the newest ones while it is
too slow for all (`pace`). A link that has failed for good is logged as fatal, is an error in
`/diagnostics`, and ends the process with exit code 1, so that a launch file can start it anew.
"""

import sys
import time
from collections.abc import Callable

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from lumitip_msgs.msg import Contact, Estimate, Values
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from rclpy.qos import qos_profile_sensor_data
from std_srvs.srv import Trigger
from tf2_ros import TransformBroadcaster
from visualization_msgs.msg import MarkerArray

from lumitip import Fingertip, Frame, LumitipError
from lumitip.estimation import PoseEstimator
from lumitip.links.base import LinkEvent
from lumitip.links.url import Url
from lumitip.processing import Tracker
from lumitip.view.drawn import ESTIMATE, PUBLISHED, borders
from lumitip.view.pose import described, reach_of
from lumitip_ros import health, markers, messages
from lumitip_ros.pace import Pace, Published

PARAMETERS: dict[str, str | bool | float] = {
    "url": "twin://demo",
    "layout": "",
    "frame_id": "lumitip_receiver",
    "line_frame_id": "lumitip_line",
    "estimate": True,
    "gap_mm": 3.0,
    "diameter_mm": 3.0,
    "stale_s": 0.5,
}
"""Name and default of each; see README.md."""
_DIAGNOSTICS_S = 1.0
_MARKERS_S = 1.0 / 30.0
_SENDING_S = 0.5  # longest wait for the last messages to be received


class FingertipNode(LifecycleNode):
    """Publishes a fingertip while it is active."""

    def __init__(self) -> None:
        super().__init__("fingertip")
        for name, default in PARAMETERS.items():
            self.declare_parameter(name, default)
        self._tip: Fingertip | None = None
        self._stop: Callable[[], None] | None = None
        self._pace: Pace | None = None
        self._published = Published()
        self._failed = self._refused = ""
        self._recorded = False
        self._marked_s = float("-inf")
        sensor = qos_profile_sensor_data
        self._values = self.create_lifecycle_publisher(Values, "~/values", sensor)
        self._contact = self.create_lifecycle_publisher(Contact, "~/contact", sensor)
        self._estimate = self.create_lifecycle_publisher(Estimate, "~/estimate", sensor)
        self._markers = self.create_lifecycle_publisher(MarkerArray, "~/markers", 10)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._transforms = TransformBroadcaster(self)
        # Taring is in the group of the transitions: none of them closes the link meanwhile.
        self.create_service(Trigger, "~/tare", self._tare)
        # Diagnostics go on while a transition or taring waits for the fingertip.
        apart = MutuallyExclusiveCallbackGroup()
        self.create_timer(_DIAGNOSTICS_S, self.diagnose, callback_group=apart)

    @property
    def failure(self) -> str:
        """Why the open link has failed for good; empty while it has not."""
        return self._failed if self._tip is not None else ""

    def on_configure(self, _: State) -> TransitionCallbackReturn:
        """Connect; without success the node stays unconfigured."""
        self._failed = self._refused = ""
        self._published = Published()
        try:
            self._tip = self._open()
            self._track, self._pose = Tracker(self._tip.layout), None
            if self.get_parameter("estimate").value:
                self._pose = self._estimator(self._tip)
        except Exception as error:  # noqa: BLE001 - rclpy would swallow it without a word
            expected = isinstance(error, LumitipError)
            self._refused = str(error) if expected else repr(error)
            self.get_logger().error(self._refused)
            self._close()
            return TransitionCallbackReturn.FAILURE
        self.get_logger().info(f"{self._tip.device_id}: {len(self._tip.layout)} cells")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Publish from now on."""
        result = super().on_activate(state)
        if self._tip is not None:
            self._published.newest_s = time.monotonic()
            self._pace = Pace(self._publish, self._every, self._published)
            self._stop = self._tip.subscribe(self._pace.put)
        return result

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Publish no more, and delete the markers; the link stays."""
        self._pause()
        return super().on_deactivate(state)

    def on_cleanup(self, _: State) -> TransitionCallbackReturn:
        """Disconnect."""
        self._close()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, _: State) -> TransitionCallbackReturn:
        """Delete the markers of an active node, and disconnect."""
        self._close()
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, _: State) -> TransitionCallbackReturn:
        """Disconnect; the node is then unconfigured."""
        self._close()
        return TransitionCallbackReturn.SUCCESS

    def destroy_node(self) -> None:
        """Disconnect, then destroy the node."""
        self._close()
        super().destroy_node()

    def diagnose(self) -> None:
        """Publish the state of the fingertip."""
        name, stale_s = self.get_fully_qualified_name(), self._number("stale_s")
        now = health.Condition(
            self._tip, self._failed, self._refused, stale_s, self._published, self._recorded
        )
        status = health.status(name, now)
        stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(health.array(status, stamp))

    def finish(self) -> None:
        """Publish the last diagnostics and delete the markers; wait until both have been received,
        for at most half a second each."""
        self.diagnose()
        self._pause()
        for last in (self._diagnostics, self._markers):
            last.wait_for_all_acked(Duration(seconds=_SENDING_S))

    def _open(self) -> Fingertip:
        """Connect; a recording does not play before the node is active."""
        url = self._text("url")
        address = Url.parse(url)
        self._recorded = address.scheme == "replay"
        # At speed 0 a recording waits for this node, so every frame can be published.
        self._every = self._recorded and address.number("speed", 1.0, 0.0, 1000.0) == 0.0
        layout = self._text("layout") or None
        if self._every:
            return Fingertip.open(url, layout, buffer=1, on_event=self._on_event)
        return Fingertip.open(url, layout, on_event=self._on_event)

    def _estimator(self, tip: Fingertip) -> PoseEstimator:
        try:
            return PoseEstimator(
                tip.layout,
                gap_mm=self._number("gap_mm"),
                diameter_mm=self._number("diameter_mm"),
                tracking=True,
            ).prepare()
        except LumitipError as error:
            raise LumitipError(f"{error}. The parameter estimate: false does without") from error

    def _publish(self, frame: Frame, arrival_s: float) -> None:
        """Publish a frame; on the thread of `Pace`, which publishers may be used from."""
        try:
            self._publish_all(frame, self._stamp_s(frame, arrival_s))
            self._published.number += 1
            # The times of a recording are those of another clock.
            self._published.newest_s = arrival_s if self._recorded else min(frame.t, arrival_s)
        except Exception as error:  # noqa: BLE001 - the thread would end without a word
            if rclpy.ok():  # else publishers are gone: the process ends
                self._fail(f"a frame could not be published: {error!r}")

    def _stamp_s(self, frame: Frame, arrival_s: float) -> float:
        """When the cells were read (seconds since 1970). A recording that plays in real time begins
        again at its end: with its own times tf2 would ignore it from then on."""
        if self._recorded and not self._every:
            return time.time() - (time.monotonic() - arrival_s)
        return frame.t_wall

    def _publish_all(self, frame: Frame, stamp_s: float) -> None:
        tip = self._tip
        if tip is None:
            return
        header = messages.header(stamp_s, self._text("frame_id"))
        contact = self._track(frame.values)
        self._values.publish(messages.values(frame, header))
        self._contact.publish(messages.contact(contact, header))
        estimate = self._pose(frame.values) if self._pose else None
        if estimate:
            self._estimate.publish(messages.estimate(estimate, header))
            if estimate.trusted:
                child = self._text("line_frame_id")
                self._transforms.sendTransform(messages.line_transform(estimate, header, child))
        now_s = time.monotonic()
        if now_s - self._marked_s < _MARKERS_S:
            return
        self._marked_s, reach_mm = now_s, reach_of(tip.layout)
        drawn = [markers.cells(frame, tip.layout, header)]
        lines = borders(contact, reach_mm)
        drawn.append(markers.lines(lines, PUBLISHED, "published", header))
        if estimate:
            lines = described(estimate, reach_mm)["lines"]
            drawn.append(markers.lines(lines, ESTIMATE, "estimate", header))
        self._markers.publish(MarkerArray(markers=drawn))

    def _tare(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Measure the empty grasp."""
        try:
            if self._tip is None:
                raise LumitipError("the node is not configured: no fingertip is open")
            self._tip.tare()
            response.success, response.message = True, "empty grasp measured and saved"
        except LumitipError as error:
            response.success, response.message = False, str(error)
        return response

    def _on_event(self, event: LinkEvent) -> None:
        """Log an event of the link."""
        log = self.get_logger()
        if event.kind in ("failed", "ended"):
            self._fail(event.detail)
        elif event.kind in ("lost", "restarted", "clock"):
            log.warning(event.detail)
        else:
            log.info(event.detail)

    def _fail(self, why: str) -> None:
        self._failed = why
        self.get_logger().fatal(why)

    def _pause(self) -> None:
        if self._stop:
            self._stop()
        if self._pace:
            self._pace.stop()
            if rclpy.ok():  # else publishers are gone
                self._markers.publish(markers.none())
        self._stop = self._pace = self._published.newest_s = None

    def _close(self) -> None:
        self._pause()
        if self._tip is not None:
            self._tip.close()
        self._tip = None

    def _text(self, name: str) -> str:
        return str(self.get_parameter(name).value)

    def _number(self, name: str) -> float:
        return float(self.get_parameter(name).value)


def main() -> None:
    """Run until it is interrupted, or until its link has failed for good: exit code 1."""
    rclpy.init()
    node = FingertipNode()
    executor = MultiThreadedExecutor(2)  # one thread for diagnostics
    executor.add_node(node)
    failure = ""
    try:
        while rclpy.ok() and not failure:
            executor.spin_once(timeout_sec=0.2)
            failure = node.failure
        if failure:
            node.finish()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(1 if failure else 0)


if __name__ == "__main__":
    main()

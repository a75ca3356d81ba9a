"""The lifecycle node `fingertip`.

Configured, it is connected; active, it publishes every frame. A link that is given up is logged as
fatal, is an error in `/diagnostics`, and ends the process with exit code 1, so that a launch file
can start it anew.
"""

import sys
import time
from collections.abc import Callable

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from lumitip_msgs.msg import Contact, Estimate, Values
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from rclpy.qos import qos_profile_sensor_data
from std_srvs.srv import Trigger
from tf2_ros import TransformBroadcaster
from visualization_msgs.msg import MarkerArray

from lumitip import Fingertip, Frame, LumitipError
from lumitip.estimation import PoseEstimator
from lumitip.links.base import LinkEvent
from lumitip.processing import Tracker
from lumitip.view.pose import described, reach_of
from lumitip.view.rerun_sink import borders
from lumitip_ros import health, markers, messages

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


class FingertipNode(LifecycleNode):
    """Publishes a fingertip while it is active."""

    def __init__(self) -> None:
        super().__init__("fingertip")
        for name, default in PARAMETERS.items():
            self.declare_parameter(name, default)
        self.failure = ""
        """Why the link was given up."""
        self._tip: Fingertip | None = None
        self._stop: Callable[[], None] | None = None
        self._marked_s = self._newest_s = float("-inf")
        sensor = qos_profile_sensor_data
        self._values = self.create_lifecycle_publisher(Values, "~/values", sensor)
        self._contact = self.create_lifecycle_publisher(Contact, "~/contact", sensor)
        self._estimate = self.create_lifecycle_publisher(Estimate, "~/estimate", sensor)
        self._markers = self.create_lifecycle_publisher(MarkerArray, "~/markers", sensor)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._transforms = TransformBroadcaster(self)
        self.create_service(Trigger, "~/tare", self._tare)
        self.create_timer(_DIAGNOSTICS_S, self._diagnose)

    def on_configure(self, _: State) -> TransitionCallbackReturn:
        """Connect; without success the node stays unconfigured."""
        try:
            self._tip = Fingertip.open(
                self._text("url"), self._text("layout") or None, on_event=self._on_event
            )
            self._track, self._pose = Tracker(self._tip.layout), None
            if self.get_parameter("estimate").value:
                self._pose = PoseEstimator(
                    self._tip.layout,
                    gap_mm=self._number("gap_mm"),
                    diameter_mm=self._number("diameter_mm"),
                    tracking=True,
                ).prepare()
        except LumitipError as error:
            self.get_logger().error(str(error))
            self._close()
            return TransitionCallbackReturn.FAILURE
        self.get_logger().info(f"{self._tip.device_id}: {len(self._tip.layout)} cells")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        """Publish from now on."""
        result = super().on_activate(state)
        if self._tip is not None:
            self._stop = self._tip.subscribe(self._publish)
        return result

    def on_deactivate(self, state: State) -> TransitionCallbackReturn:
        """Publish no more; the link stays."""
        self._pause()
        return super().on_deactivate(state)

    def on_cleanup(self, _: State) -> TransitionCallbackReturn:
        """Disconnect."""
        self._close()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, _: State) -> TransitionCallbackReturn:
        """Disconnect."""
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

    def _publish(self, frame: Frame) -> None:
        """Publish a frame; on a thread of the fingertip, which publishers may be used from."""
        tip = self._tip
        if tip is None:
            return
        self._newest_s = time.monotonic()
        head = messages.header(frame, self._text("frame_id"))
        contact = self._track(frame.values)
        self._values.publish(messages.values(frame, head))
        self._contact.publish(messages.contact(contact, head))
        estimate = self._pose(frame.values) if self._pose else None
        if estimate:
            self._estimate.publish(messages.estimate(estimate, head))
            if estimate.trusted:
                child = self._text("line_frame_id")
                self._transforms.sendTransform(messages.line_transform(estimate, head, child))
        if self._newest_s - self._marked_s < _MARKERS_S:
            return
        self._marked_s, reach_mm = self._newest_s, reach_of(tip.layout)
        drawn = [markers.cells(frame, tip.layout, head)]
        lines = borders(contact, reach_mm)
        drawn.append(markers.lines(lines, markers.PUBLISHED, "published", head))
        if estimate:
            lines = described(estimate, reach_mm)["lines"]
            drawn.append(markers.lines(lines, markers.ESTIMATE, "estimate", head))
        self._markers.publish(markers.together(drawn))

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
        """Log an event of the link, and remember that it was given up."""
        log = self.get_logger()
        if event.kind in ("failed", "ended"):
            self.failure = event.detail
            log.fatal(event.detail)
        elif event.kind in ("lost", "restarted"):
            log.warning(event.detail)
        else:
            log.info(event.detail)

    def _diagnose(self) -> None:
        newest_s = self._newest_s
        age_s = time.monotonic() - newest_s if newest_s > float("-inf") else None
        stale_s = self._number("stale_s")
        found = health.status(self.get_name(), self._tip, self.failure, age_s, stale_s)
        self._diagnostics.publish(health.array(found, self.get_clock().now().to_msg()))

    def _pause(self) -> None:
        if self._stop:
            self._stop()
        self._stop = None

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
    """Run until it is interrupted, or until its link is given up: exit code 1."""
    rclpy.init()
    node = FingertipNode()
    executor = MultiThreadedExecutor(2)  # taring waits for frames
    executor.add_node(node)
    try:
        while rclpy.ok() and not node.failure:
            executor.spin_once(timeout_sec=0.2)
        if node.failure:
            node._diagnose()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    sys.exit(1 if node.failure else 0)


if __name__ == "__main__":
    main()

"""A ROS 2 node that publishes a fingertip. Untested on ROS: only against stand-ins of its classes.

    python examples/ros2_node.py --ros-args -p url:=ble://Lumitip -p layout:=outputs/layout.json

~/values (std_msgs/Float32MultiArray) is the light of every cell, 255 is full light. ~/centre
(geometry_msgs/PointStamped) is the dark centre, in metres in the sensor frame: the mean of the dark
cells, each weighted with 255 - value.
"""

import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from std_msgs.msg import Float32MultiArray

from lumitip import Fingertip, Frame
from lumitip.processing import Processor


class FingertipNode(Node):
    """Publishes every frame as it comes."""

    def __init__(self) -> None:
        super().__init__("lumitip")
        url = self.declare_parameter("url", "twin://demo").value
        layout = self.declare_parameter("layout", "").value
        self.frame_id = self.declare_parameter("frame_id", "fingertip").value
        self.values = self.create_publisher(Float32MultiArray, "~/values", 10)
        self.centre = self.create_publisher(PointStamped, "~/centre", 10)
        self.tip = Fingertip.open(
            url, layout or None, on_event=lambda event: self.get_logger().info(event.detail)
        )
        self.processor = Processor(self.tip.layout)
        self.tip.subscribe(self.publish)  # publishers may be used from any thread

    def publish(self, frame: Frame) -> None:
        """Publish one frame, with the time at which its cells were read."""
        self.values.publish(Float32MultiArray(data=frame.values.tolist()))
        contact = self.processor(frame.values)
        if contact.centre_mm is None:
            return
        point = PointStamped()
        point.header.frame_id = self.frame_id
        point.header.stamp.sec = int(frame.t_wall)
        point.header.stamp.nanosec = int(frame.t_wall % 1 * 1e9)
        point.point.x, point.point.y = (float(mm) * 1e-3 for mm in contact.centre_mm)
        self.centre.publish(point)

    def destroy_node(self) -> None:
        """Disconnect, then destroy the node."""
        self.tip.close()
        super().destroy_node()


def main() -> None:
    """Run until it is interrupted."""
    rclpy.init()
    node = FingertipNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()

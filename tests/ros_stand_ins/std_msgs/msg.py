"""Stands in for `std_msgs.msg`."""


class Float32MultiArray:
    """Numbers; ROS takes a list of floats and nothing else."""

    def __init__(self, data):
        assert type(data) is list
        assert all(type(number) is float for number in data)
        self._data = data

    def __repr__(self):
        return f"{len(self._data)} values, mean {sum(self._data) / len(self._data):.3f}"

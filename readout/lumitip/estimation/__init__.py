"""Pose of an edge, a cable or a corner, by fitting the optical model. Needs numpy alone.

estimate = PoseEstimator(layout)(frame.values)
estimate.kind, estimate.offset_mm, estimate.angle_deg, estimate.flags
"""

from lumitip.estimation.estimate import KINDS, Estimate
from lumitip.estimation.estimator import EstimationError, PoseEstimator
from lumitip.estimation.learn import Learned, learn

__all__ = ["KINDS", "Estimate", "EstimationError", "Learned", "PoseEstimator", "learn"]

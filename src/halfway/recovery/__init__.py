"""Whole materials from a few measured directions, how sure they are, and which directions to measure."""

from . import log_relative
from .plan import Plan, plan
from .recovery import Completion, Recovery, recover
from .setup import Probes, Setup

__all__ = ["Completion", "Plan", "Probes", "Recovery", "Setup", "log_relative", "plan", "recover"]

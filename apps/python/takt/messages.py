"""The types of the LCM messages of takt. lcm-gen makes them from share/lcm when the package is
built; the modules of the package import them from here. Each type is also a name of the package:
takt.image_t.
"""
from .axis_motion_t import axis_motion_t
from .command_t import command_t
from .diagnosis_t import diagnosis_t
from .envelope_t import envelope_t
from .event_t import event_t
from .histogram_t import histogram_t
from .image_t import image_t
from .layout_t import layout_t
from .motion_command_t import motion_command_t
from .motion_gear_t import motion_gear_t
from .motion_goal_t import motion_goal_t
from .motion_point_t import motion_point_t
from .motion_stream_t import motion_stream_t
from .motion_t import motion_t
from .node_status_t import node_status_t
from .pdo_state_t import pdo_state_t
from .pdo_status_t import pdo_status_t
from .reply_t import reply_t
from .request_t import request_t
from .signal_t import signal_t
from .speed_axes_t import speed_axes_t
from .speed_axis_t import speed_axis_t
from .speed_pattern_t import speed_pattern_t
from .status_t import status_t
from .sync_status_t import sync_status_t
from .timing_t import timing_t
from .transfer_state_t import transfer_state_t
from .transfer_t import transfer_t

__all__ = [
    "axis_motion_t", "command_t", "diagnosis_t", "envelope_t", "event_t", "histogram_t",
    "image_t", "layout_t", "motion_command_t", "motion_gear_t", "motion_goal_t",
    "motion_point_t", "motion_stream_t", "motion_t", "node_status_t", "pdo_state_t",
    "pdo_status_t", "reply_t", "request_t", "signal_t", "speed_axes_t", "speed_axis_t",
    "speed_pattern_t", "status_t", "sync_status_t", "timing_t", "transfer_state_t", "transfer_t",
]

"""One axis of a CiA 402 drive: its objects, its state, and its controlwords. Used by Axes."""

CONTROLWORD, STATUSWORD, MODE, MODE_DISPLAY = 0x6040, 0x6041, 0x6060, 0x6061
POSITION, VELOCITY = 0x6064, 0x606C  # actual position and velocity
TARGET, TARGET_VELOCITY, TARGET_TORQUE = 0x607A, 0x60FF, 0x6071
# Touch probe: function, status, and positions at the rising and the falling edge of inputs 1 and 2.
PROBE_FUNCTION, PROBE_STATUS, PROBE_POSITION = 0x60B8, 0x60B9, 0x60BA
PROBE_POSITIONS = range(PROBE_POSITION, PROBE_POSITION + 4)
INTERPOLATION_TARGET = 0x60C1  # sub-index 1
# The objects that an axis has in its PDOs, and whether the master sends them.
OBJECTS = ({(index, True)
            for index in (CONTROLWORD, MODE, TARGET, TARGET_VELOCITY, TARGET_TORQUE,
                          PROBE_FUNCTION, INTERPOLATION_TARGET)} |
           {(index, False) for index in (STATUSWORD, MODE_DISPLAY, POSITION, VELOCITY,
                                         PROBE_STATUS, *PROBE_POSITIONS)})
# The objects of each further axis of a device are 0x800 higher.
FIRST_OBJECT, LAST_OBJECT, AXIS_STEP = 0x6000, 0x9FFF, 0x800
# Modes of operation (0x6060).
PROFILE_POSITION, PROFILE_VELOCITY, HOMING = 1, 3, 6
INTERPOLATED_POSITION, CYCLIC_SYNCHRONOUS_POSITION = 7, 8
INTERPOLATE = 0x10  # bit 4 of the controlword in interpolated position mode
START_HOMING = 0x10  # bit 4 of the controlword in homing mode
HALT = 0x100  # bit 8 of the controlword
# Bits of the statusword: bit 10, bits 12 and 13 in homing mode, and bit 12 in profile velocity
# mode.
TARGET_REACHED, HOMING_RESULT, SPEED_IS_0 = 0x0400, 0x3000, 0x1000
ENABLED, QUICK_STOP = "operation enabled", "quick stop active"
FAULTS = ("fault", "fault reaction active")
DISABLED = ("switch on disabled", "not ready to switch on", "fault")
# Mask and pattern of the statusword, state, and the bit that shows why the drive is not enabled.
STATES = ((0x4F, 0x00, "not ready to switch on", "bit 0 (ready to switch on)", 0),
          (0x4F, 0x40, "switch on disabled", "bit 6 (switch on disabled)", 1),
          (0x6F, 0x21, "ready to switch on", "bit 1 (switched on)", 0),
          (0x6F, 0x23, "switched on", "bit 2 (operation enabled)", 0),
          (0x6F, 0x27, ENABLED, "", 0),
          (0x6F, 0x07, QUICK_STOP, "bit 5 (quick stop)", 0),
          (0x4F, 0x0F, "fault reaction active", "bit 3 (fault)", 1),
          (0x4F, 0x08, "fault", "bit 3 (fault)", 1))
ENABLE_OPERATION = 0x0F  # controlword
# The controlword for each state on the way to Operation enabled, on the way back, and to keep the
# state. For all other states, it is 0 (Disable voltage).
ENABLING = {"switch on disabled": 0x06, "ready to switch on": 0x07, "switched on": 0x0F,
            ENABLED: ENABLE_OPERATION}
DISABLING = {ENABLED: 0x07, "switched on": 0x06}
KEEPING = {"ready to switch on": 0x06, "switched on": 0x07, ENABLED: ENABLE_OPERATION,
           QUICK_STOP: 0x02}
RESETTING = KEEPING | {"fault": 0x80}
QUICK_STOPPING = {ENABLED: 0x02, QUICK_STOP: 0x02}


class Axis:
    """The reported values of one axis, and the commands of this program for it."""

    def __init__(self, name: str, node: str, node_id: int, number: int):
        self.name, self.node, self.node_id, self.number = name, node, node_id, number
        # Places of its objects in the layout, and their signal_t. The keys are the indices that
        # these objects have on the first axis of a device.
        self.places, self.signals = {}, {}
        self.statusword = None  # of the newest image
        self.motion, self.motion_cycle = None, -1  # the newest axis_motion_t and its cycle
        self.held = 0  # number of status_t in sequence in which another program holds the node
        self.mode = CYCLIC_SYNCHRONOUS_POSITION  # commanded mode of operation
        self.mode_bits = 0  # bits of the controlword that the mode defines, in Operation enabled
        self.target = None  # raw target position of a set-point in profile position mode
        self.has_own_target = False  # this program, and not taktd, has commanded a target

    @property
    def state(self) -> str:
        if self.statusword is None:
            return "unknown"
        return next((name for mask, bits, name, _, _ in STATES if self.statusword & mask == bits),
                    "unknown")

    @property
    def enabled(self) -> bool:
        return self.state == ENABLED

    @property
    def has_target(self) -> bool:
        """True if taktd can command positions of the axis."""
        return self.target_object in self.places

    @property
    def target_object(self) -> int:
        """The object in which taktd commands positions."""
        return TARGET if TARGET in self.places else INTERPOLATION_TARGET

    @property
    def motion_mode(self) -> int:
        """The mode in which taktd moves the axis: cyclic synchronous position, or interpolated
        position if 0x60C1:01 is in its RPDOs and 0x607A is not."""
        interpolates = self.has_target and self.target_object == INTERPOLATION_TARGET
        return INTERPOLATED_POSITION if interpolates else CYCLIC_SYNCHRONOUS_POSITION

    @property
    def obeys_motions(self) -> bool:
        return self.mode == self.motion_mode

    def change_mode(self, mode: int) -> None:
        """Sets the commanded mode. Cyclic synchronous position means the mode in which taktd moves
        the axis."""
        self.mode = self.motion_mode if mode == CYCLIC_SYNCHRONOUS_POSITION else mode
        self.mode_bits = INTERPOLATE if self.mode == INTERPOLATED_POSITION else 0
        self.target = None

    def says_rest(self, halted: bool) -> bool:
        """True if the statusword shows that the drive is at rest. In modes that are not named here,
        bit 10 has another meaning or none."""
        if not self.enabled:
            return False
        if self.mode == PROFILE_VELOCITY:
            return self.statusword & SPEED_IS_0 != 0
        return (halted or self.mode in (PROFILE_POSITION, HOMING)) and (
            self.statusword & TARGET_REACHED != 0)

    def controlword(self, words: dict) -> int:
        word = words.get(self.state, 0)
        keeps = self.enabled and word == ENABLE_OPERATION
        return word | (self.mode_bits if keeps else 0)

    def bits(self) -> str:
        """Names the bits of the statusword that show why the drive is not enabled."""
        if self.statusword is None:
            return "its statusword has not arrived"
        word = f"its statusword 0x{self.statusword:04X}"
        bit, value = next(((bit, value) for _, _, name, bit, value in STATES if name == self.state),
                          ("", 0))
        text = f"{bit} of {word} is {value}" if bit else f"{word} shows no state of CiA 402"
        if not self.statusword & 0x0010:
            text += "; bit 4 (voltage enabled) is 0: is its power supply on?"
        if not self.statusword & 0x0200:
            text += ("; bit 9 (remote) is 0: the drive ignores the controlword; "
                     "is it in local control?")
        return text

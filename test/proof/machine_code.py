"""The functions of a program as they are in its machine code: instructions with their source lines.

Only what `objdump` prints is read. The program needs line numbers (`-g1`), which change no instruction.
"""
import dataclasses
import re
import subprocess

ENDS = ("ret", "ud2", "hlt", "repz ret")
COLD = r" \[clone \.cold\]|\.cold$"  # the part of a function that GCC expects to run seldom


@dataclasses.dataclass
class Instruction:
    address: int
    words: str  # mnemonic and operands
    line: tuple[str, int]  # source file and line
    target: int | None = None  # of a jump or call
    target_name: str = ""

    @property
    def name(self):
        return self.words.split()[0] if self.words else ""

    @property
    def is_call(self):
        return self.name == "call"

    @property
    def is_jump(self):
        return self.name.startswith("j")

    @property
    def goes_on(self):
        """Says whether the next instruction can follow."""
        return self.name != "jmp" and not self.words.startswith(ENDS)


@dataclasses.dataclass
class Function:
    name: str
    code: dict[int, Instruction]  # by address, in ascending order
    entry: int = 0


def functions_of(program):
    """Returns the functions of a program by their names. The cold part of a function belongs to it."""
    command = ["objdump", "--disassemble", "--demangle", "--no-show-raw-insn", "--line-numbers", program]
    found, function, line = {}, None, ("", 0)
    for text in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        if head := re.match(r"^([0-9a-f]+) <(.*)>:$", text):
            name = re.sub(COLD + r"| \[clone \.localalias\]", "", head[2])
            function, line = found.setdefault(name, Function(name, {})), ("", 0)
            if not re.search(COLD, head[2]):
                function.entry = int(head[1], 16)
        elif place := re.match(r"^(/.*):(\d+)( \(discriminator \d+\))?$", text):
            line = (place[1], int(place[2]))
        elif function and (found_code := re.match(r"^\s*([0-9a-f]+):\t(.*)$", text)):
            words = re.sub(r"^(bnd|notrack|data16|cs) ", "", found_code[2].strip())
            instruction = Instruction(int(found_code[1], 16), words, line)
            if goal := re.match(r"^(?:call|j\w+)\s+([0-9a-f]+) <(.*?)>$", words):
                instruction.target, instruction.target_name = int(goal[1], 16), goal[2]
            function.code[instruction.address] = instruction
    return found

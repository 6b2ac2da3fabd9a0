"""What tests of programs beside a running taktd share: checks, waits, and a taktd with simulated devices."""
import pathlib
import signal
import socket
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NETWORK = ROOT / "share/demo/two_axes.yaml"
PATIENCE = 180  # s; what a test waits for comes much earlier
failures = []


def check(what, good, told=""):
    print(("ok    " if good else "FAIL  ") + what, flush=True)
    if not good:
        failures.append(what)
        print("      " + str(told)[-8000:].replace("\n", "\n      "))


def await_true(what, condition, process=None, told=lambda: ""):
    """Ends the test if the condition does not become true, or if the process ends before."""
    until = time.monotonic() + PATIENCE
    while True:
        ended = process and process.poll() is not None  # before the condition, which may come with the end
        if condition():
            return
        if time.monotonic() > until:
            sys.exit(f"not in {PATIENCE} s: {what}\n{told()}")
        if ended:
            sys.exit(f"ended with {process.returncode} before: {what}\n{told()}")
        time.sleep(0.05)


def await_text(path, text, process):
    """Waits until the process has written this text to its output in `path`."""
    await_true(text, lambda: text in path.read_text(), process, path.read_text)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Bus:
    """A taktd with simulated devices, and the programs beside it. What a program prints is in the file NAME.log of the folder."""

    def __init__(self, binaries, folder):
        self.binaries, self.folder = pathlib.Path(binaries), pathlib.Path(folder)
        self.url = f"tcpq://127.0.0.1:{free_port()}"

    def start(self, name, *words):
        with open(self.log_of(name), "w") as said:
            return subprocess.Popen([self.binaries / name, *words, "--lcm-url", self.url], stdout=said, stderr=said)

    def log_of(self, name):
        return self.folder / f"{name}.log"

    def start_daemon(self, network=NETWORK, *words):
        """Returns when all nodes have booted."""
        self.daemon = self.start("taktd", network, "--bus", "sim", *words)
        try:
            await_text(self.log_of("taktd"), "the network is ready", self.daemon)
        except SystemExit:
            self.daemon.kill()
            raise

    def end_daemon(self):
        """Returns the exit code."""
        self.daemon.send_signal(signal.SIGTERM)
        return self.daemon.wait(PATIENCE)

    def takt(self, *words, **more):
        return subprocess.run([self.binaries / "takt", *words, "--lcm-url", self.url], capture_output=True, text=True,
                              timeout=PATIENCE, stdin=subprocess.DEVNULL, **more)

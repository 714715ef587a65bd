"""A program that stays alive, pinned to one core, and answers commands."""

import subprocess


class Program:
    def __init__(self, name, command, cpu):
        self.name = name
        words = ["taskset", "-c", str(cpu), *map(str, command)]
        self.process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        ready, ticks_per_nanosecond, step = self.line().split()
        assert ready == "ready"
        self.ticks_per_nanosecond, self.step = float(ticks_per_nanosecond), float(step)

    def send(self, line):
        self.process.stdin.write(line.encode() + b"\n")
        self.process.stdin.flush()

    def line(self):
        """The next line of its answer; empty once it has ended."""
        return self.process.stdout.readline().decode()

    def read(self, count, what):
        """So many bytes of its answer."""
        data = self.process.stdout.read(count)
        if len(data) != count:
            raise SystemExit(f"{self.name} died at: {what}")
        return data

    def close(self):
        self.process.stdin.close()
        self.process.wait()

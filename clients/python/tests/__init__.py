"""Tests of the client against a daemon of its own. `CLEARANCE_BIN` names the daemon's program."""

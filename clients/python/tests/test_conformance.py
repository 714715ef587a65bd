"""The recorded answers of tests/data/conformance are brought, byte for byte; tests/clients/record.rs says what a line means."""

from collections import Counter

from google.protobuf import message_factory
from google.protobuf.message import Message

import clearance
from clearance.errors import translated
from clearance.v1 import service_pb2 as service

from .daemon import ROOT, DaemonTest, ZenohTest

RECORDS = ROOT / "tests" / "data" / "conformance" / "records.txt"


class Conformance(DaemonTest):
    def test_the_recorded_answers_are_brought(self) -> None:
        self.ask_all(self.client)

    def ask_all(self, client: clearance.Client) -> None:
        seen: Counter[str] = Counter()
        for line in RECORDS.read_text().splitlines():
            if line.startswith("#"):
                continue
            kind, first, *rest = line.split(" ", 3)
            seen[kind] += 1
            with self.subTest(line[:120]):
                if kind == "asset":
                    client.upload([(ROOT / first).read_bytes()])
                elif kind == "ask":
                    self.assertEqual(canonical(ask(client, first, rest[0])), rest[1])
                elif kind == "refuse":
                    with self.assertRaises(clearance.ClearanceError) as caught, translated():
                        ask(client, first, rest[0])
                    error = caught.exception
                    self.assertEqual(f"{error.code} {error.reason} {error.field or '-'}", rest[1])
                else:
                    questions = [service.QueryStreamRequest.FromString(digits(text)) for text in rest[0].split(",")]
                    answers = client._queries.QueryStream(iter(questions), timeout=30)
                    self.assertEqual(",".join(canonical(answer) for answer in answers), rest[1])
        self.assertEqual(set(seen), {"asset", "ask", "refuse", "stream"})


class ConformanceThroughZenoh(ZenohTest):
    def test_the_recorded_answers_are_brought(self) -> None:
        Conformance.ask_all(self, self.through_zenoh)


def ask(client: clearance.Client, method: str, request: str) -> Message:
    service_name, method_name = method.split("/")
    described = service.DESCRIPTOR.services_by_name[service_name].methods_by_name[method_name]
    sent = message_factory.GetMessageClass(described.input_type).FromString(digits(request))
    stub = getattr(client, f"_{service_name.lower()}")
    return getattr(stub, method_name)(sent, timeout=30)


def digits(text: str) -> bytes:
    return bytes.fromhex(text.removeprefix("-"))


def canonical(message: Message) -> str:
    """The message's bytes as digits, without epochs and counts of nodes."""
    clear(message)
    return message.SerializeToString(deterministic=True).hex() or "-"


def clear(message: Message) -> None:
    for field, value in message.ListFields():
        if field.name == "epoch" or (field.name == "nodes" and message.DESCRIPTOR.name == "Cost"):
            message.ClearField(field.name)
        elif field.message_type is None or field.message_type.GetOptions().map_entry:
            continue
        elif field.is_repeated:
            for each in value:
                clear(each)
        else:
            clear(value)

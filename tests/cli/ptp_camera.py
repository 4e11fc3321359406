"""A camera that is not there, for libgphoto2: PTP over TCP/IP (CIPA DC-005) on loopback, with what cameras do wrong.

Its photographs are even, as bright as their exposure is long, and say how long that was.
"""
import socket
import struct
import threading
import time

OK, BUSY, UNSUPPORTED, BAD_HANDLE, FULL = 0x2001, 0x2019, 0x2005, 0x2009, 0x200C
STORAGE, FOLDER, TIFF, ASSOCIATION = 0x00010001, 1, 0x300D, 0x3001
EXPOSURES = [10, 20, 40, 80, 125, 250, 500, 1000, 2500, 5000, 10000, 20000]  # 0.1 ms


def text(value):
    return bytes([len(value) + 1]) + (value + "\0").encode("utf-16-le") if value else b"\0"


def numbers(values):
    return struct.pack("<I", len(values)) + b"".join(struct.pack("<H", value) for value in values)


def tiff(side, level, exposure_s, mark):
    """An even grey of 16 bits, but for a mark in its corner, for no two photographs are alike; exposure_s None: the file
    does not say it."""
    pixels = struct.pack("<H", 64 * mark) + struct.pack("<H", level) * (side * side * 3 - 1)
    entries = [(256, 4, 1, side), (257, 4, 1, side), (258, 3, 3, None), (259, 3, 1, 1), (262, 3, 1, 2), (273, 4, 1, None),
               (277, 3, 1, 3), (278, 4, 1, side), (279, 4, 1, len(pixels)), (284, 3, 1, 1)]
    if exposure_s is not None:
        entries.append((34665, 4, 1, None))
    end = 8 + 2 + 12 * len(entries) + 4
    bits, exif, data = end, end + 6, end + 6 + 2 + 12 + 4 + 8
    places = {258: bits, 273: data, 34665: exif}
    head = struct.pack("<2sHIH", b"II", 42, 8, len(entries))
    for tag, kind, count, value in entries:
        head += struct.pack("<HHII", tag, kind, count, places.get(tag, value))
    head += struct.pack("<I", 0) + struct.pack("<HHH", 16, 16, 16)
    head += struct.pack("<HHHIII", 1, 33434, 5, 1, exif + 18, 0)
    return head + struct.pack("<II", round((exposure_s or 0) * 1e6), 1000000) + pixels


class Camera:
    """Serves any number of connections. `drop` and `silent` are numbers of captures at which it misbehaves, `busy` those
    of settings of the shutter: there the EOS 60D answers that it is busy. Its card is full after `room` photographs of
    its own. With `bulb` its shutter can stay open until it is told to close, and the file says how long, in whole
    seconds, `off` by so much."""

    def __init__(self, side, busy=(), drop=(), silent=(), room=1000, bulb=False, off=0):
        self.side, self.busy, self.drop, self.silent, self.room = side, busy, drop, silent, room
        self.times = EXPOSURES[:7] if bulb else EXPOSURES  # that have a name: up to 0.1 s, or 2 s
        self.bulb, self.off, self.opened, self.release, self.fresh = bulb, off, 0, 0, None
        self.speed = 2  # per second: full after half of one
        self.exposure, self.settings, self.asked, self.taken, self.sessions = EXPOSURES[0], 0, 0, [], 0
        self.objects = {}  # handle: (name, bytes)
        self.events = None
        self.listener = socket.create_server(("127.0.0.1", 0))
        number = self.listener.getsockname()[1]
        self.port = "ptpip:127.0.0.1:%d:%d" % (number, number)  # of commands and of events
        threading.Thread(target=self.accept, daemon=True).start()

    def accept(self):
        while True:
            connection, _ = self.listener.accept()
            threading.Thread(target=self.serve, args=(connection,), daemon=True).start()

    # ---- Packets ----

    @staticmethod
    def receive(connection):
        def exactly(size):
            data = b""
            while len(data) < size:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_QUICKACK, 1)  # libgphoto2 waits for that
                piece = connection.recv(size - len(data))
                if not piece:
                    raise ConnectionError
                data += piece
            return data
        size, kind = struct.unpack("<II", exactly(8))
        return kind, exactly(size - 8)

    @staticmethod
    def send(connection, kind, body):
        connection.sendall(struct.pack("<II", 8 + len(body), kind) + body)

    def serve(self, connection):
        try:
            kind, _ = self.receive(connection)
            if kind == 3:  # the channel of events
                self.send(connection, 4, b"")
                self.events = connection
                while True:
                    self.receive(connection)
            self.send(connection, 2, struct.pack("<I", 1) + bytes(16) + "fake\0".encode("utf-16-le") +
                      struct.pack("<HH", 0, 1))
            while True:
                self.command(connection)
        except (ConnectionError, OSError):
            connection.close()

    def command(self, connection):
        kind, body = self.receive(connection)
        if kind != 6:
            return
        phase, code, transaction = struct.unpack("<IHI", body[:10])
        parameters = struct.unpack("<%dI" % ((len(body) - 10) // 4), body[10:])
        data = self.receive_data(connection) if phase == 2 else b""
        answer, out = self.carry_out(connection, code, parameters, data)
        if out is not None:
            self.send(connection, 9, struct.pack("<IQ", transaction, len(out)))
            self.send(connection, 12, struct.pack("<I", transaction) + out)
        self.send(connection, 7, struct.pack("<HI", answer, transaction))
        if code == 0x100E and answer == OK and self.fresh:
            self.announce()

    def receive_data(self, connection):
        data = b""
        while True:
            kind, body = self.receive(connection)
            if kind in (10, 12):
                data += body[4:]
            if kind == 12:
                return data

    def event(self, code, parameter):
        self.send(self.events, 8, struct.pack("<HII", code, 0, parameter))

    # ---- What it can do ----

    def carry_out(self, connection, code, parameters, data):
        handler = {0x1001: self.device_info, 0x1002: self.open_session, 0x1004: self.storages, 0x1005: self.storage_info,
                   0x1007: self.handles, 0x1008: self.object_info, 0x1009: self.get_object, 0x1014: self.describe_exposure,
                   0x1015: self.get_exposure}.get(code)
        if handler:
            return handler(*parameters)
        if code == 0x1016 and parameters[0] == 0x500D:
            self.settings += 1
            if self.settings in self.busy:
                return BUSY, None
            self.exposure = struct.unpack("<I", data)[0]
            return OK, None
        if code == 0x1016 and parameters[0] == 0xD208 and self.bulb:
            self.release = struct.unpack("<H", data)[0]
            return OK, None
        if code == 0x100E and self.release:
            return self.press_release()
        if code == 0x100E:
            return self.capture(connection)
        return (OK, None) if code == 0x1003 else (UNSUPPORTED, None)

    def device_info(self, *_):
        operations = [0x1001, 0x1002, 0x1003, 0x1004, 0x1005, 0x1007, 0x1008, 0x1009, 0x100E, 0x1014, 0x1015, 0x1016]
        return OK, (struct.pack("<HIH", 100, 0, 0) + text("") + struct.pack("<H", 0) + numbers(operations) +
                    numbers([0x4002, 0x400D]) + numbers([0x500D]) + numbers([TIFF]) + numbers([TIFF]) + text("Weft") +
                    text("Fake camera") + text("1") + text("7"))

    def open_session(self, *_):
        self.sessions += 1
        return OK, None

    def storages(self, *_):
        return OK, struct.pack("<II", 1, STORAGE)

    def storage_info(self, *_):
        left = self.room - len(self.taken)
        return OK, struct.pack("<HHHQQI", 3, 2, 0, 1 << 34, left << 20, left) + text("card") + text("card")

    def handles(self, _storage=0, _form=0, parent=0, *_):
        found = [FOLDER] if parent in (0, 0xFFFFFFFF) else sorted(self.objects) if parent == FOLDER else []
        return OK, struct.pack("<I", len(found)) + b"".join(struct.pack("<I", handle) for handle in found)

    def object_info(self, handle, *_):
        if handle != FOLDER and handle not in self.objects:
            return BAD_HANDLE, None
        name, data = self.objects.get(handle, ("DCIM", b""))
        folder = handle == FOLDER
        return OK, (struct.pack("<IHHIHIIIIIIIHII", STORAGE, ASSOCIATION if folder else TIFF, 0, len(data), 0, 0, 0, 0, self.side,
                                self.side, 16, 0 if folder else FOLDER, 1 if folder else 0, 0, 0) + text(name) +
                    text("20260101T000000") + text("20260101T000000") + text(""))

    def get_object(self, handle, *_):
        return (OK, self.objects[handle][1]) if handle in self.objects else (BAD_HANDLE, None)

    def describe_exposure(self, code, *_):
        if code != 0x500D:
            return UNSUPPORTED, None
        return OK, (struct.pack("<HHBIIBH", 0x500D, 6, 1, EXPOSURES[0], self.exposure, 2, len(self.times)) +
                    b"".join(struct.pack("<I", value) for value in self.times))

    def get_exposure(self, *_):
        return OK, struct.pack("<I", self.exposure)

    # ---- Photographs ----

    def add(self, level, exposure_s):
        handle = 100 + len(self.objects)
        self.objects[handle] = ("IMG_%04d.TIF" % handle, tiff(self.side, level, exposure_s, handle))
        return handle

    def capture(self, connection):
        self.asked += 1
        if self.asked in self.drop:
            self.events.shutdown(socket.SHUT_RDWR)
            connection.shutdown(socket.SHUT_RDWR)
            raise ConnectionError
        exposure_s = self.exposure * 1e-4
        return self.shoot(exposure_s, None if self.asked in self.silent else exposure_s)

    def press_release(self):
        """As Fujifilm's do: half down, down for as long as it takes, up."""
        release, self.fresh = self.release, None
        if release == 0x0500:
            self.opened = time.monotonic()
        if release == 0x000C:
            self.release, lasted_s = 0, time.monotonic() - self.opened
            return self.shoot(lasted_s, round(lasted_s) + self.off)
        return OK, None

    def shoot(self, exposure_s, noted_s):
        if len(self.taken) >= self.room:
            return FULL, None
        level = min(65535, round(65535 * exposure_s * self.speed))
        self.taken.append((exposure_s, level))
        self.fresh = self.add(level, noted_s)
        return OK, None

    def announce(self):
        """The photograph; and one that somebody took with the camera's own button, after it."""
        self.event(0x4002, self.fresh)
        self.event(0x400D, 0)
        self.event(0x4002, self.add(1, 9))

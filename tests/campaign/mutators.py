# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes files at random: bytes, texts, trees of JSON, DICOM elements, HDF5 with mended checksums, sealed models. Each
function takes bytes and a random.Random, and returns bytes."""
import copy
import gzip
import hashlib
import io
import itertools
import json
import logging
import re
import struct
import sys
import warnings

import h5py
import numpy
import pydicom

# pydicom shall write what is wrong, and say nothing about it.
pydicom.config.settings.reading_validation_mode = pydicom.config.IGNORE
pydicom.config.settings.writing_validation_mode = pydicom.config.IGNORE
logging.getLogger("pydicom").setLevel(logging.CRITICAL + 1)
warnings.filterwarnings("ignore", module="pydicom")
# At Python's own limit pydicom would describe the data once more at each of the levels that it leaves.
sys.setrecursionlimit(20_000)

ESCAPE = "\x1b]0;title\x07\x1b[31mred\x7f\u009b2J\r\u202eder\u2028"
NUMBERS = ("-1", "0", "1", "255", "65536", "2147483648", "4294967295", "99999999999999999999", "1e308", "-1e308",
           "1e-320", "nan",
           "inf", "-inf", "1e999", "0x10", "1,5", "")
VALUES = (None, True, -1, 0, 0.5, 1e308, -1e308, 2**31, 2**63, 2**64, "", "x" * 5000, ESCAPE, "nan", [], {}, [[]],
          [None], {"": 0}, "\0")
INTEGERS = (0, 1, 2, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, 0xffffffffffffffff)


def integer(random):
    """An extreme or random whole number of 1, 2, 4 or 8 bytes in either order of bytes."""
    size = random.choice((1, 2, 4, 8))
    value = random.choice((*INTEGERS, random.getrandbits(64))) & (1 << 8 * size) - 1
    return value.to_bytes(size, random.choice(("little", "big")))


def in_pieces(data, random):
    """One change of a few bytes anywhere, or near the beginning, where headers are."""
    at = random.randrange(min(len(data), random.choice((64, 400, len(data)))) or 1)
    length = 1 + random.randrange(random.choice((4, 40, 4000)))
    match random.randrange(8):
        case 0:
            return data[:at] + bytes([data[at] ^ 1 << random.randrange(8)]) + data[at + 1:] if data else data
        case 1:
            new = integer(random)
            return data[:at] + new + data[at + len(new):]
        case 2:
            return data[:at] + random.choice((b"\0", b"\xff")) * length + data[at + length:]
        case 3:
            return data[:at] + data[at + length:]
        case 4:
            return data[:at] + data[at:at + length] * random.choice((2, 2, 50)) + data[at + length:]
        case 5:
            return data[:at]
        case 6:
            other = random.randrange(len(data) or 1)
            return data[:at] + data[other:other + length] + data[at + length:]
        case _:
            return data[:at] + random.randbytes(length) + data[at + length:]


def raw(data, random):
    for _ in range(random.choice((1, 1, 2, 5))):
        data = in_pieces(data, random)
    return data


def in_text(data, random):
    lines = data.split(b"\n")
    k = random.randrange(len(lines))
    match random.randrange(9):
        case 0 | 1 | 2:  # another number in place of one of them
            numbers = list(re.finditer(rb"[-+]?\d[\d.eE+-]*", data))
            if not numbers:
                return raw(data, random)
            one = random.choice(numbers)
            return data[:one.start()] + random.choice(NUMBERS).encode() + data[one.end():]
        case 3:
            del lines[k]
        case 4:
            lines.insert(k, lines[random.randrange(len(lines))])
        case 5:
            other = random.randrange(len(lines))
            lines[k], lines[other] = lines[other], lines[k]
        case 6:
            words = list(re.finditer(rb"[A-Za-z_]{2,}", data))
            if not words:
                return raw(data, random)
            one = random.choice(words)
            new = random.choice((ESCAPE.encode(), b"x" * 5000, b"caf\xe9", b"a\0b", b"", random.choice(words)[0], b'"',
                                 b"\\"))
            return data[:one.start()] + new + data[one.end():]
        case 7:
            lines[k] = random.choice((b"[" * 50000, b"{" * 50000, b'"' + b"\\" * 999, b"," * 9999, b"\xff\xfe\0", b"#",
                                      ESCAPE.encode()))
        case _:
            return raw(data, random)
    return b"\n".join(lines)


def text(data, random):
    for _ in range(random.choice((1, 1, 1, 3))):
        data = in_text(data, random)
    return data


def places(value, at=()):
    """The paths of all parts of a JSON value."""
    yield at
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in parts:
        yield from places(part, (*at, key))


def tree(data, random):
    """Another value, no value, two values or many levels at one place of a JSON file."""
    if random.random() < 0.3:
        return text(data, random)
    value = json.loads(data)
    for _ in range(random.choice((1, 1, 2))):
        *way, key = random.choice([p for p in places(value) if p] or [(None,)])
        inside = value
        for step in way:
            inside = inside[step]
        if key is None:
            break
        match random.randrange(6):
            case 0:
                del inside[key]
            case 1 if isinstance(inside, list):
                inside[key:key] = [copy.deepcopy(inside[key])] * random.choice((1, 1, 300))
            case 2:
                inside[key] = [inside[key]]
            case 3 if isinstance(inside, dict):
                inside[random.choice((ESCAPE, "", "x" * 5000, "version", key + " "))] = inside.pop(key)
            case _:
                inside[key] = random.choice(VALUES)
    changed = json.dumps(value).encode()
    if random.random() < 0.05:
        changed = changed.replace(b"null", b"[" * 100000 + b"]" * 100000, 1)
    return changed


def zipped(mutator):
    """The mutator of what a gzip file has in it."""
    def changed(data, random):
        if random.random() < 0.2:
            return raw(data, random)
        return gzip.compress(mutator(gzip.decompress(data), random), mtime=0)
    return changed


# DICOM

LONG = (b"OB", b"OD", b"OF", b"OL", b"OW", b"SQ", b"UC", b"UN", b"UR", b"UT")
MOST_DATASETS = 20_000
OTHER_VRS = (b"SQ", b"UN", b"OB", b"DS", b"IS", b"US", b"FL", b"CS", b"UI", b"PN", b"??")


def elements(data):
    """The elements of an explicit little-endian file at all levels: (begin, place of the length, its size, begin of the
    value, end of the value). The places of items are among them."""
    found = []

    def walk(at, end):
        while at + 8 <= end:
            group, = struct.unpack_from("<H", data, at)
            if group == 0xfffe:
                length_at, size = at + 4, 4
            else:
                length_at, size = (at + 8, 4) if data[at + 4:at + 6] in LONG else (at + 6, 2)
            value = length_at + size
            length = int.from_bytes(data[length_at:value], "little")
            is_open = size == 4 and length == 0xffffffff
            last = min(end, value if is_open else value + length)
            found.append((at, length_at, size, value, last))
            if group == 0xfffe or data[at + 4:at + 6] == b"SQ":
                if not is_open:
                    walk(value, last)
            at = last
    walk(132, len(data))
    return found


def dicom_bytes(data, random):
    """Wrong lengths and kinds, elements that are missing or there twice; the lengths around them are as before."""
    begin, length_at, size, value, end = random.choice(elements(data))
    match random.randrange(5):
        case 0 | 1:
            length = end - value
            wrong = random.choice((*INTEGERS, length + 1, length + 2, max(0, length - 1), 2 * length,
                                   0xfffffffe)) & (1 << 8 * size) - 1
            return data[:length_at] + wrong.to_bytes(size, "little") + data[length_at + size:]
        case 2:
            return data[:begin + 4] + random.choice(OTHER_VRS) + data[begin + 6:]
        case 3:
            return data[:begin] + data[begin:end] * random.choice((2, 2, 100)) + data[end:]
        case _:
            return data[:begin] + data[end:]


def datasets(dataset):
    yield dataset
    for element in dataset:
        if element.VR == "SQ":
            for item in element.value:
                yield from datasets(item)


def nested(levels):
    item = pydicom.Dataset()
    for _ in range(levels):
        outer = pydicom.Dataset()
        outer.add_new(0x300a0230, "SQ", [item])
        item = outer
    return item


def dicom_tree(data, random):
    """A well-formed file with an odd content."""
    file = pydicom.dcmread(io.BytesIO(data))
    for _ in range(random.choice((1, 1, 2, 4))):
        dataset = random.choice([d for d in datasets(file) if len(d)])
        element = dataset[random.choice(list(dataset.keys()))]
        if random.random() < 0.2:
            del dataset[element.tag]
        elif element.VR == "SQ":
            items = list(element.value)
            match random.randrange(4):
                case 0:
                    items = []
                case 1:
                    items = items * random.choice((2, 200 if len(items) < 10 else 2))
                case 2:
                    items = [nested(random.choice((3, 60, 250)))]
                case _:
                    random.shuffle(items)
                    items = items[:max(0, len(items) - 1)] + [pydicom.Dataset()]
            dataset[element.tag] = pydicom.DataElement(element.tag, "SQ", pydicom.Sequence(items))
        elif isinstance(element.value, (bytes, bytearray)):
            # pylint: disable-next=protected-access
            element._value = in_pieces(bytes(element.value), random)
        elif element.VR in ("US", "UL", "SS", "SL"):
            element._value = random.choice((0, 1, 2, 127, [1, 2, 3], []))
        elif element.VR in ("FD", "FL"):
            element._value = random.choice((0.0, -1.0, 1e30, float("nan"), [0.0, 0.0, 0.0], [float("inf")] * 3, []))
        elif element.VR == "AT":
            del dataset[element.tag]
        else:
            element._value = random.choice((*NUMBERS, ESCAPE, "x" * 3000, "0\\0\\0", "1\\2", "\\\\",
                                            "1.2.840.10008.1.2.1"))
        if sum(1 for _ in itertools.islice(datasets(file), MOST_DATASETS + 1)) > MOST_DATASETS:
            raise ValueError("items that were repeated within each other")
    out = io.BytesIO()
    file.save_as(out)
    return out.getvalue()


def dicom(data, random):
    try:
        match random.randrange(4):
            case 0:
                return raw(data, random)
            case 1:
                return dicom_bytes(data, random)
            case 2:
                return dicom_tree(data, random)
            case _:
                return dicom_bytes(dicom_tree(data, random), random)
    except (ValueError, TypeError, AttributeError, KeyError, OSError, struct.error, OverflowError, NotImplementedError):
        return dicom_bytes(data, random)  # pydicom does not write everything


# HDF5

CHECKED = (b"OHDR", b"OCHK", b"FRHP", b"FHDB", b"FHIB", b"BTHD", b"BTIN", b"BTLF", b"FSHD", b"FSSE", b"SMTB", b"EAHD",
           b"EAIB", b"EASB",
           b"EADB", b"FAHD", b"FADB")
LONGEST_BLOCK = 1100
WORD = 0xffffffff


def lookup3(data):
    """The checksum of HDF5's metadata: Jenkins's hashlittle with the start value 0."""
    def turned(x, k):
        return (x << k | x >> 32 - k) & WORD
    a = b = c = 0xdeadbeef + len(data) & WORD
    while len(data) > 12:
        x, y, z = struct.unpack_from("<3I", data)
        a, b, c = a + x & WORD, b + y & WORD, c + z & WORD
        a = (a - c & WORD) ^ turned(c, 4); c = c + b & WORD
        b = (b - a & WORD) ^ turned(a, 6); a = a + c & WORD
        c = (c - b & WORD) ^ turned(b, 8); b = b + a & WORD
        a = (a - c & WORD) ^ turned(c, 16); c = c + b & WORD
        b = (b - a & WORD) ^ turned(a, 19); a = a + c & WORD
        c = (c - b & WORD) ^ turned(b, 4); b = b + a & WORD
        data = data[12:]
    if not data:
        return c
    x, y, z = struct.unpack("<3I", data.ljust(12, b"\0"))
    a, b, c = a + x & WORD, b + y & WORD, c + z & WORD
    for first, second, k in (("c", "b", 14), ("a", "c", 11), ("b", "a", 25), ("c", "b", 16), ("a", "c", 4),
                             ("b", "a", 14), ("c", "b", 24)):
        v = {"a": a, "b": b, "c": c}
        v[first] = (v[first] ^ v[second]) - turned(v[second], k) & WORD
        a, b, c = v["a"], v["b"], v["c"]
    return c


def checked_blocks(data):
    """Begin and end of each block of an HDF5 file whose checksum follows it."""
    found = [(0, 44)] if data[8] in (2, 3) and lookup3(data[:44]) == int.from_bytes(data[44:48], "little") else []
    for mark in CHECKED:
        for one in re.finditer(mark, data):
            begin = one.start()
            for end in range(begin + 8, min(begin + LONGEST_BLOCK, len(data) - 4)):
                # The first byte of the checksum is rarely right by chance where the whole is not.
                if lookup3(data[begin:end]) == int.from_bytes(data[end:end + 4], "little"):
                    found.append((begin, end))
                    break
    return found


def hdf5_blocks(blocks):
    """The mutator of an HDF5 file's metadata, in these checked blocks. Their checksums are right afterwards."""
    def changed(data, random):
        data = bytearray(data)
        for _ in range(random.choice((1, 1, 2, 4))):
            begin, end = random.choice(blocks)
            at = random.randrange(begin + 4, end)
            new = integer(random)[:end - at]
            data[at:at + len(new)] = new
            data[end:end + 4] = lookup3(bytes(data[begin:end])).to_bytes(4, "little")
        return bytes(data)
    return changed


def odd_numbers(values, random):
    """An array with some odd numbers."""
    values = numpy.array(values)
    if values.size == 0 or values.dtype.kind not in "iuf":
        return values
    flat = values.reshape(-1)
    kinds = (numpy.nan, numpy.inf, -numpy.inf, 0, -1, 1e300, 1e-320) if values.dtype.kind == "f" else (0, -1, 1,
                                                                                                       2**31 - 1, 2**62)
    for _ in range(random.choice((1, 1, 10))):
        at = random.randrange(flat.size)
        with numpy.errstate(all="ignore"):
            flat[at:at + random.choice((1, 1, flat.size))] = numpy.array(random.choice(kinds)).astype(values.dtype)
    return values


def hdf5_content(data, random):
    """A sound HDF5 file whose values, texts, shapes or names are others."""
    store = io.BytesIO(data)
    with h5py.File(store, "r+", libver="latest") as file:
        names = []
        file.visit(names.append)
        for _ in range(random.choice((1, 1, 2, 4))):
            name = random.choice([*names, "/"])
            if name not in file:
                continue
            thing = file[name]
            attributes = list(thing.attrs)
            if attributes and (random.random() < 0.4 or name == "/"):
                key = random.choice(attributes)
                value = thing.attrs[key]
                if random.random() < 0.15:
                    del thing.attrs[key]
                elif isinstance(value, (str, bytes)):
                    old = value.encode() if isinstance(value, str) else value
                    new = text(old, random).replace(b"\0", b"").decode("utf-8", "replace").encode()[:60000]
                    del thing.attrs[key]
                    thing.attrs[key] = new.decode("utf-8", "ignore")
                else:
                    thing.attrs[key] = odd_numbers(value,
                                                   random) if random.random() < 0.8 else random.choice(("", ESCAPE,
                                                                                                        [1, 2, 3]))
            elif name == "/":
                continue
            elif random.random() < 0.15:
                del file[name]
            elif isinstance(thing, h5py.Dataset):
                values = thing[()]
                match random.randrange(4):
                    case 0 if isinstance(values, numpy.ndarray) and values.dtype.names:
                        field = random.choice(values.dtype.names)
                        values[field] = odd_numbers(values[field], random)
                        thing[...] = values
                    case 0 | 1 if isinstance(values, numpy.ndarray):
                        thing[...] = odd_numbers(values, random)
                    case 2 if isinstance(values, numpy.ndarray) and values.ndim:
                        count = random.choice((0, 1, values.shape[0] - 1, values.shape[0] + 1, 2 * values.shape[0]))
                        del file[name]
                        file[name] = numpy.resize(values, (max(count, 0), *values.shape[1:]))
                    case 3:
                        del file[name]
                        file[name] = random.choice((0, "text", numpy.zeros((2, 3)), numpy.arange(5)))
                    case _:
                        if isinstance(values, bytes):
                            del file[name]
                            file[name] = text(values, random).replace(b"\0", b"").decode("utf-8", "replace")
            else:
                file.move(name, name + random.choice(("2", " ", "x" * 300)))
    return store.getvalue()


def hdf5(blocks):
    """The mutator of HDF5 files with these checked blocks."""
    by_block = hdf5_blocks(blocks)

    def changed(data, random):
        try:
            return random.choice((raw, by_block, by_block, hdf5_content, hdf5_content))(data, random)
        except (OSError, ValueError, TypeError, KeyError, RuntimeError):
            return by_block(data, random)  # h5py does not write everything
    return changed


# Saved models

MARK, LENGTH, DIGEST = b"\nstylet seal 1\n", 16, 64


def sealed(content, index):
    data = content + index + MARK + b"%0*d" % (LENGTH, len(index))
    return data + hashlib.sha256(data).hexdigest().encode()


def model(blocks):
    """The mutator of models saved by `stylet prepare`: content or index are changed, and the seal fits them."""
    by_content = hdf5(blocks)

    def changed(data, random):
        if random.random() < 0.1:
            return raw(data, random)
        before = len(data) - DIGEST - LENGTH - len(MARK)
        length = int(data[before + len(MARK):before + len(MARK) + LENGTH])
        content, index = data[:before - length], data[before - length:before]
        if random.random() < 0.5:
            return sealed(content, tree(index, random))
        return sealed(by_content(content, random), index)
    return changed

"""Looks at a co-simulation unit with FMPy: python3 check.py UNIT.fmu EXPECTED.json

EXPECTED.json holds the kernel's step (s) as `step`, the values that are set as `set`, the values of outputs after every step as
`rows`, with their names in `columns`, what outputs are about at the start as `first`, and settings that are `refused` after it;
perhaps a command that is set before every step as `commanded`, with `name` and `speeds`, with the `rows` that it makes.
The unit must be valid, and have these bits whatever the communication steps, after
its state was saved and restored, and after it was written down and read by another instance.
"""

import json
import shutil
import struct
import sys

import fmpy
from fmpy.validation import validate_fmu

SLACK = 1e-3


class Unit:
    """An instance of either version of the standard."""

    def __init__(self, folder, description):
        self.instance = fmpy.instantiate_fmu(folder, description, "CoSimulation")
        self.is_third = description.fmiVersion.startswith("3")
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}

    def start(self, values):
        self.set(values)
        if self.is_third:
            self.instance.enterInitializationMode(startTime=0.0)
        else:
            self.instance.setupExperiment(startTime=0.0)
            self.instance.enterInitializationMode()
        self.instance.exitInitializationMode()
        return self

    def set(self, values):
        names = [self.references[name] for name in values]
        (self.instance.setFloat64 if self.is_third else self.instance.setReal)(names, list(values.values()))

    def get(self, names):
        references = [self.references[name] for name in names]
        return list((self.instance.getFloat64 if self.is_third else self.instance.getReal)(references))

    def step(self, time, size):
        self.instance.doStep(currentCommunicationPoint=time, communicationStepSize=size)

    def save(self):
        return self.instance.getFMUState() if self.is_third else self.instance.getFMUstate()

    def restore(self, state):
        (self.instance.setFMUState if self.is_third else self.instance.setFMUstate)(state)

    def written(self, state):
        return self.instance.serializeFMUState(state) if self.is_third else self.instance.serializeFMUstate(state)

    def read(self, text):
        if self.is_third:
            return self.instance.deserializeFMUState(text)
        return self.instance.deSerializeFMUstate(text)

    def end(self):
        self.instance.terminate()
        self.instance.freeInstance()


def bits(values):
    return [struct.pack("<d", value) for value in values]


def main(path, expected):
    problems = validate_fmu(path)
    assert not problems, problems
    with open(expected, encoding="utf-8") as file:
        expected = json.load(file)
    step, columns, rows = expected["step"], expected["columns"], expected["rows"]
    last = len(rows) - 1
    description = fmpy.read_model_description(path)
    folder = fmpy.extract(path)

    def check(unit, time):
        at = int(time / step + SLACK)
        assert bits(unit.get(columns)) == bits(rows[at]), (time, at, unit.get(columns), rows[at])

    def run(unit, time, size, end):
        """Goes on from `time` by steps of `size` and looks at every communication point."""
        check(unit, time)
        steps = 0
        while time + size <= end * (1 + 1e-9):
            unit.step(time, size)
            time += size
            steps += 1
            check(unit, time)
        return time

    for size in [step, 0.4 * step, 2.5 * step, 7 * step, last * step]:
        unit = Unit(folder, description).start(expected["set"])
        run(unit, 0.0, size, last * step)
        unit.end()

    unit = Unit(folder, description).start(expected["set"])
    for name, value in expected["first"].items():
        [found] = unit.get([name])
        assert abs(found - value) < 3e-8, (name, found, value)
    half = run(unit, 0.0, 1.6 * step, 0.5 * last * step)
    state = unit.save()
    text = unit.written(state)
    run(unit, half, step, last * step)
    unit.restore(state)
    run(unit, half, 0.7 * step, last * step)
    # Parameters are read with the state.
    other = Unit(folder, description).start({})
    read = other.read(text)
    other.restore(read)
    end = run(other, half, 3.3 * step, last * step)
    assert other.written(read) == text
    # No damage to what was written is read.
    for i in range(len(text)):
        damaged = bytearray(text)
        damaged[i] ^= 1 << i % 8
        try:
            other.read(bytes(damaged))
        except Exception:
            continue
        raise AssertionError(f"a state with a flipped bit in byte {i} was read")
    check(other, end)
    for state, of in [(state, unit), (read, other)]:
        (of.instance.freeFMUState if of.is_third else of.instance.freeFMUstate)(state)
    other.end()

    if "commanded" in expected:
        commanded, unit_commanded = expected["commanded"], Unit(folder, description).start(expected["set"])
        for at, (speed, row) in enumerate(zip(commanded["speeds"], commanded["rows"])):
            unit_commanded.set({commanded["name"]: speed})
            if at % 1000 == 500:
                saved = unit_commanded.written(unit_commanded.save())
                unit_commanded.step(at * step, step)
                unit_commanded.restore(unit_commanded.read(saved))
            unit_commanded.step(at * step, step)
            assert bits(unit_commanded.get(columns)) == bits(row), (at, unit_commanded.get(columns), row)
        unit_commanded.end()

    # A reset instance is a new one.
    unit.instance.reset()
    unit.start(expected["set"])
    run(unit, 0.0, 11 * step, last * step)
    # What is fixed stays; what no kernel is made of is refused and changes nothing.
    for name, value in expected["refused"]:
        before = unit.get([name])
        try:
            unit.set({name: value})
        except Exception:
            assert unit.get([name]) == before
        else:
            raise AssertionError(f"{name} = {value} was taken")
    unit.end()
    shutil.rmtree(folder)
    print(f"FMI {description.fmiVersion}, {len(description.modelVariables)} variables, {last} steps")


if __name__ == "__main__":
    main(*sys.argv[1:])

"""Every field of a result has the type that its class states, for all shipped scenes."""

import re
import types
import typing

import pytest

import slipfit
from slipfit._commands import SceneCommands
from slipfit._result import _kinds

#: Commands, and options that keep them short.
COMMANDS = {
    "check": {},
    "simulate": {},
    "sweep": {"n": "0:1:1"},
    "population": {"units": 16, "threads": 2},
    "tolerance": {"samples": 200, "draws": True},
    "precision": {},
}


def fits(value, kind):
    """Whether a value has a type, without what is wrong within results."""
    origin, arguments = typing.get_origin(kind) or kind, typing.get_args(kind)
    if origin in (typing.Union, types.UnionType):
        return any(fits(value, one) for one in arguments)
    if origin is typing.Any:
        return True
    if origin is list:
        return isinstance(value, list) and all(fits(one, arguments[0]) for one in value)
    if origin is dict:
        return isinstance(value, dict) and all(fits(one, arguments[1]) for one in value.values())
    return type(value) is origin


def wrong(result, at):
    """What does not hold of a result and of all in it."""
    kinds = _kinds(type(result))
    for name in result:
        value, kind = result[name], kinds.get(name)
        if kind is None or not fits(value, kind):
            yield f"{at}.{name} of {type(result).__name__} is {type(value).__name__} {str(value)[:60]}, stated is {kind}"
        for one in value if isinstance(value, list) else value.values() if isinstance(value, dict) else [value]:
            if isinstance(one, slipfit.Result):
                yield from wrong(one, f"{at}.{name}")
    for name, kind in kinds.items():
        if name not in result and type(None) not in typing.get_args(kind):
            yield f"{at}: {type(result).__name__} has no {name}"


@pytest.mark.parametrize("scene", slipfit.shipped())
def test_fields_have_their_types(scene):
    done = 0
    for command, options in COMMANDS.items():
        # Of a slide it takes minutes.
        if command == "precision" and scene != "slider-crank":
            continue
        try:
            result = getattr(slipfit.Scene(scene), command)(picture=True, **options)
        except slipfit.InputError:
            # The scene has nothing for the command; that pictures are wished for is no reason.
            with pytest.raises(slipfit.InputError):
                getattr(slipfit.Scene(scene), command)(**options)
            continue
        done += 1
        assert list(wrong(result, f"{command} {scene}")) == []
        assert all(svg.startswith("<svg") for svg in result.pictures.values())
        assert "<table>" in result._repr_html_()
    assert done >= 2 and "<table>" in slipfit.Scene(scene)._repr_html_()


def test_fields_of_other_results_have_their_types(tmp_path):
    slide, drawing, clutch = (slipfit.Scene(name) for name in ("cd-rom-slide", "cd-rom-slide-drawing", "clutch"))
    out = {"out": tmp_path / "part"}
    all_results = [
        slide.table(output=tmp_path / "table.bin", n="0:1:0.5", picture=True),
        slide.table(output=tmp_path / "production.bin", production=True, units=600, picture=True),
        slide.kernel(output=tmp_path / "kernel.h"),
        slide.fmu(output=tmp_path / "slide.fmu"),
        slide.sweep(over=["friction.coefficient=0.2:0.3:0.1", "slide.mass=80:90:10"], picture=True),
        slide.precision(stability=True, random=1, picture=True),
        drawing.population(units=64, rare=True, picture=True),
        drawing.population(units=600, shard="1/2", picture=True, **out),
        clutch.tolerance(samples=600, shard="1/2", picture=True, out=tmp_path / "other"),
        slipfit.Scene("clutch-processes").allocate(samples=2000, picture=True),
        slipfit.capability({"width (mm)": [10.0 + 0.001 * (k * k % 17) for k in range(40)]}),
    ]
    for result in all_results:
        assert list(wrong(result, type(result).__name__)) == []
        assert "<table>" in result._repr_html_()
    assert {name: len(result.pictures) for result in all_results if (name := type(result).__name__) in ("Table", "Sweep", "Precision", "Population")} == {
        "Table": 0, "Sweep": 1, "Precision": 1, "Population": 1
    }
    assert sum(type(result) is slipfit.results.Shard for result in all_results) == 2


def test_every_class_is_a_result_of_a_command_or_a_field():
    classes = {name for name, one in vars(slipfit.results).items() if isinstance(one, type) and issubclass(one, slipfit.Result)} - {"Result"}
    named = {name for one in classes for kind in getattr(slipfit.results, one).__annotations__.values() for name in re.findall(r"\w+", kind)}
    functions = [slipfit.Scene.identify, slipfit.merge, slipfit.capability]
    functions += [of for name, of in vars(SceneCommands).items() if not name.startswith("_")]
    returned = {name for of in functions for name in re.findall(r"results\.(\w+)", of.__annotations__["return"])} | {"Shard"}
    assert classes - named - returned == set()


def test_a_field_of_several_kinds_has_the_one_that_fits():
    assert type(slipfit.Scene("slider-crank").simulate().controller) is slipfit.results.MechanismController
    assert type(slipfit.Scene("cd-rom-slide").simulate().controller) is slipfit.results.ControllerComparison
    gaps = [slipfit.Scene(name).check().gaps[0] for name in ("cd-rom-slide", "slider-crank")]
    assert [type(gap) for gap in gaps] == [slipfit.results.Gap, slipfit.results.Play]

"""Measurements: the three kinds of files say the same, and what is wrong in them is said with its place."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from halfway import Measurements
from halfway.errors import FormatError
from halfway.formats import spectra
from halfway.measurements import read_measurements, write_directions, write_measurements

HEADER = "theta_i [deg],phi_i [deg],theta_o [deg],phi_o [deg],r [1/sr],g [1/sr],b [1/sr]"
ROWS = ["30,0,30,180,0.5,0.25,0.125", "0,0,60,90,0.2,0.2,0.2"]
ASTM = """TITLE "paint"
NUM_POINTS 2
VARS theta_i,phi_i,theta_r,phi_r,R,G,B
0.523598776,0,0.523598776,3.14159265,0.5,0.25,0.125
0,0,1.04719755,1.57079633,0.2,0.2,0.2
"""


def bird(**changes: object) -> str:
    def of(unit: str, *values: float) -> dict[str, object]:
        return {"unit": unit, "values": list(values)}

    data = {
        "theta_i": of("deg", 30, 0),
        "phi_i": of("deg", 0, 0),
        "theta_r": of("deg", 30, 60),
        "phi_r": of("rad", np.pi, np.pi / 2),
        "BRDF": of("sr^-1", 0.5, 0.2),
    }
    return json.dumps({"metadata": {}, "data": data | changes})


def read(folder: Path, text: str) -> Measurements:
    path = folder / "paint.txt"
    path.write_text(text, encoding="utf-8")
    return read_measurements(path)


def assert_is_paint(measurements: Measurements) -> None:
    s, c = 0.5, np.sqrt(0.75)
    assert_allclose(measurements.wi, [[s, 0, c], [0, 0, 1]], atol=1e-8)
    assert_allclose(measurements.wo, [[-s, 0, c], [0, c, s]], atol=1e-8)
    assert measurements.name == "paint"


def test_csv_names_its_columns_and_units(tmp_path: Path):
    measurements = read(tmp_path, "\n".join(["# a comment", HEADER, *ROWS, ""]))
    assert_is_paint(measurements)
    assert_allclose(measurements.values, [[0.5, 0.25, 0.125], [0.2, 0.2, 0.2]])


@pytest.mark.parametrize("separator", [";", "\t"])
def test_csv_may_be_separated_otherwise(tmp_path: Path, separator: str):
    assert_is_paint(read(tmp_path, "\r\n".join([HEADER, *ROWS]).replace(",", separator)))


def test_csv_in_radians_and_reflectance_factors(tmp_path: Path):
    header = "theta_i (rad),theta_o (rad),phi_o (rad),f_r (factor),weight"
    measurements = read(tmp_path, f"{header}\n0,-0.5,0,{np.pi},2")
    assert_allclose(measurements.wo, [[-np.sin(0.5), 0, np.cos(0.5)]], atol=1e-12)
    assert_allclose(measurements.values, [[1, 1, 1]])
    assert measurements.weights.tolist() == [2]


def test_astm_is_in_radians(tmp_path: Path):
    measurements = read(tmp_path, ASTM)
    assert_is_paint(measurements)
    assert_allclose(measurements.values[0], [0.5, 0.25, 0.125])


def test_astm_of_one_value_and_of_wavelengths(tmp_path: Path):
    one = read(tmp_path, "VARS theta_i,phi_i,theta_s,phi_s,BRDF\n0,0,0.5,0,0.3\n")
    assert_allclose(one.values, [[0.3] * 3])
    spectral = read(tmp_path, "VARS a,b,c,d,450nm,550nm,650nm\n0,0,0.5,0,0.3,0.3,0.3\n")
    assert_allclose(spectral.values, [[0.3] * 3])


def test_brdf_json_in_its_units(tmp_path: Path):
    measurements = read(tmp_path, bird())
    assert_is_paint(measurements)
    assert_allclose(measurements.values, [[0.5] * 3, [0.2] * 3])


def test_an_uncertainty_is_a_weight(tmp_path: Path):
    percent = read(tmp_path, bird(uBRDF={"unit": "%", "values": [10, 20]}))
    assert_allclose(percent.weights, [100, 25])
    absolute = read(tmp_path, bird(uBRDF={"unit": "1/sr", "values": [0.05, 0.04]}))
    assert_allclose(absolute.weights, [100, 25])


def test_a_spectrum_down_the_rows_is_the_one_along_them(tmp_path: Path):
    wavelengths, values = np.array([450.0, 550, 650]), np.array([0.1, 0.4, 0.2])
    along = "theta_i [deg],theta_o [deg],phi_o [deg],450 nm [1/sr],550 nm [1/sr],650 nm [1/sr]\n0,0,0,0.1,0.4,0.2"
    down = "theta_i [deg],theta_o [deg],phi_o [deg],wavelength [nm],f_r [1/sr]\n" + "\n".join(
        f"0,0,0,{w},{v}" for w, v in zip(wavelengths[::-1], values[::-1], strict=True)
    )
    expected = np.maximum(spectra.rgb_weights(wavelengths) @ values, 0)
    for text in (along, down):
        assert_allclose(read(tmp_path, text).values, [expected])


def test_what_is_written_is_read_again(tmp_path: Path):
    given = read(tmp_path, "\n".join([HEADER, *ROWS]))
    write_measurements(tmp_path / "again.csv", given)
    again = read_measurements(tmp_path / "again.csv")
    for name in ("wi", "wo", "values", "weights"):
        assert_allclose(getattr(again, name), getattr(given, name), atol=1e-8)


def test_a_plan_is_to_be_filled_in(tmp_path: Path):
    given = read(tmp_path, "\n".join([HEADER, *ROWS]))
    write_directions(tmp_path / "plan.csv", given.wi, given.wo)
    with pytest.raises(
        FormatError, match=r"plan\.csv has '' at line 2, column r: expected a number"
    ):
        read_measurements(tmp_path / "plan.csv")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "paint.txt has no measurements: expected a line of column names"),
        (HEADER, "has no measurements"),
        ("theta_i,theta_o [deg],phi_o [deg],f_r [1/sr]\n1,1,1,1", "line 1 names the column theta_i without a unit: expected deg or"),
        ("theta_i [grad],theta_o [deg],phi_o [deg],f_r [1/sr]\n1,1,1,1", "names the column theta_i in 'grad'"),
        ("theta_i [deg],theta_o [deg],phi_o [deg],f_r\n1,1,1,1", "names the column f_r without a unit: expected 1/sr or"),
        ("theta_i [deg],elevation [deg]\n1,1", "line 1 names a column 'elevation"),
        ("theta_i [deg],theta_o [deg],f_r [1/sr]\n1,1,1", "has no column phi_o"),
        ("theta_i [deg],theta_i [deg],f_r [1/sr]\n1,1,1", "names the column theta_i twice"),
        ("theta_i [deg],theta_o [deg],phi_o [deg]\n1,1,1", "has no kind of values"),
        (
            "theta_i [deg],theta_o [deg],phi_o [deg],r [1/sr],g [1/sr]\n1,1,1,1,1",
            "has no column b: expected r, g and b",
        ),
        (f"{HEADER},f_r [1/sr]\n1,1,1,1,1,1,1,1", "has more than one kind of values"),
        (f"{HEADER}\n1,2,3", "line 2 has 3 cells: expected 7"),
        (f"{HEADER}\n#\n1,0,2,0,1,x,1", "has 'x' at line 3, column g: expected a number"),
        (f"{HEADER}\n1,0,95,0,1,1,1", "has 95 at line 2, column theta_o: expected less than 90 degrees"),
        (f"{HEADER}\n1,0,2,0,1,-1,1", "has -1 at line 2, column g: expected no negative value"),
        (f"{HEADER}\n1,0,2,0,1,nan,1", "has nan at line 2, column g"),
        (f"{HEADER}\n1,0,2,0,1,1,1\n1,0,2,0,1,1.5,1", "has 1 at line 2, column g and 1.5 at line 3, column g"),
        (f"{HEADER},weight\n1,0,2,0,1,1,1,0", "has 0 at line 2, column weight: expected more than 0"),
        ("VARS a,b,c\n1,2,3", "line 1 names 3 columns, and 1 rows follow: expected four angles"),
        ("VARS a,b,c,d,R,G,B\n1,2,1,1,1,1", "line 2 has 6 cells: expected 7"),
        ("VARS a,b,c,d,R,G,B\n1,2,1,1,1,1,-2", "has -2 at line 2, column b"),
        ("{", "paint.txt is damaged at line 1, column 2"),
        ("{}", "has no measurements: expected"),
        (bird(theta_i={"values": [1, 2]}), "has data.theta_i.unit None: expected deg or"),
        (bird(theta_i={"unit": "deg", "values": [1]}), "has 1 data.theta_i.values: expected 2 numbers"),
        (bird(theta_r={"unit": "deg", "values": [1, 91]}), r"has 91 at data.theta_r.values\[1\]: expected less"),
        (bird(BRDF={"unit": "1/sr", "values": [-1, 1]}), r"has -1 at data.BRDF.values\[0\]: expected no negative"),
        (bird(polarization_i={"notation": "sp", "values": ["s", "p"]}), "has 2 states of polarisation, s at data.polarization_i"),
        (bird(polarization_r={"notation": "sp", "values": ["u", [1, 1, 0, 0]]}), r"at data.polarization_r.values\[1\]"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_place(tmp_path: Path, text: str, message: str):
    with pytest.raises(FormatError, match=message):
        read(tmp_path, text)


def test_a_table_is_no_measurement(tmp_path: Path):
    path = tmp_path / "table.binary"
    path.write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(FormatError, match=r"table.binary is no text: expected CSV"):
        read_measurements(path)
    with pytest.raises(FormatError, match=r"absent.csv cannot be read"):
        read_measurements(tmp_path / "absent.csv")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"values": -np.ones((1, 3))}, "measurement 1 of 1 has f_r"),
        ({"wi": np.array([[0.0, 0, -1]])}, "expected a direction above the horizon"),
        ({"wo": np.array([[0.0, 0, 2]])}, "expected a unit vector"),
        ({"weights": np.zeros(1)}, "has weight 0.0: expected more than 0"),
        ({"values": np.ones((2, 3))}, r"have shapes \(1, 3\), \(1, 3\), \(2, 3\)"),
    ],
)
def test_arrays_that_are_no_measurements_are_refused(change: dict[str, np.ndarray], message: str):
    up = np.array([[0.0, 0, 1]])
    with pytest.raises(FormatError, match=message):
        Measurements(**{"wi": up, "wo": up, "values": np.ones((1, 3))} | change)

"""The HTML report: one file, nothing fetched, and a real browser shows, turns and picks."""

import base64
import gzip
import json
import os
import re
import shutil
from dataclasses import replace
from html.parser import HTMLParser
from io import BytesIO

import numpy as np
import pytest
from handmade_meshes import Saddle, changed, grid, icosphere
from matplotlib.image import imread

import surfmesh as sm
from surfmesh.errors import FileFormatError
from surfmesh.quality import check
from surfmesh.view import html_report
from surfmesh.view.certificate_html import _table
from surfmesh.view.histogram import BINS, histogram


class Elements(HTMLParser):
    """The scripts by id, and every address that a browser would fetch."""

    def __init__(self, text):
        super().__init__()
        self.scripts, self.addresses, self.open, self._script = {}, [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.addresses += [attributes[name] for name in ("src", "href") if name in attributes]
        self._script = attributes.get("id", "") if tag == "script" else None
        if tag not in ("meta", "link", "br", "input"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag
        self._script = None

    def handle_data(self, text):
        if self._script is not None:
            self.scripts[self._script] = self.scripts.get(self._script, "") + text


def page_of(mesh, tmp_path, **options):
    text = html_report(mesh, tmp_path / "report.html", **options).read_text("utf-8")
    return text, Elements(text)


def arrays_of(page):
    contents = json.loads(page.scripts["contents"])
    whole = gzip.decompress(base64.b64decode(page.scripts["arrays"]))
    return contents, {
        entry["name"]: np.frombuffer(whole, "<" + entry["kind"], entry["length"], entry["start"])
        for entry in contents["arrays"]
    }


def test_page_is_whole_and_fetches_nothing(saddle, tmp_path):
    text, page = page_of(saddle, tmp_path, name='<b>"saddle" & co</b>')
    assert page.addresses == ["data:,"]
    assert page.open == []  # every element is closed
    assert "<b>" not in text and "&lt;b&gt;" in text
    assert "Permission is hereby granted" in text  # the licence of what is within
    for said in ("Certificate", "Histograms", "Worst triangles", "Options", "Every figure"):
        assert f">{said}<" in text
    assert text.count("data-triangle=") == 20


def test_arrays_hold_the_mesh_wherever_it_lies(saddle, tmp_path):
    far = changed(saddle, points=1e-6 * saddle.points + (5e3, 0, -7e3))
    contents, arrays = arrays_of(page_of(far, tmp_path)[1])
    points = arrays["points"].reshape(-1, 3) * contents["scale"] + contents["centre"]
    corners = points[arrays["triangles"].reshape(-1, 3)]  # vertices are apart by face
    np.testing.assert_allclose(corners, far.points[far.triangles], atol=1e-12, rtol=0)
    np.testing.assert_array_equal(arrays["face_ids"], far.face_ids)
    assert [entry["key"] for entry in contents["colourings"]] == [
        "alpha", "angle", "size", "deviation", "face", "curvature", "gaussian", "mean"
    ]  # fmt: skip


def test_colour_values_keep_four_digits(saddle, tmp_path):
    contents, arrays = arrays_of(page_of(saddle, tmp_path)[1])
    entry = next(e for e in contents["colourings"] if e["key"] == "curvature")
    corner = arrays[entry["array"]].max()
    from surfmesh.view.colouring import colouring

    assert corner == pytest.approx(colouring(saddle, "curvature").values.max(), rel=1.3e-4)
    assert len(entry["map"]) == 6 * 256


def test_curvature_is_not_averaged_over_an_edge(tmp_path):
    """Flat faces and fillets of radius 1: no vertex has a value between theirs."""
    import cadquery as cq

    mesh = sm.mesh(cq.Workplane().box(4, 4, 4).edges("|Z").fillet(1), 0.5)
    _, arrays = arrays_of(page_of(mesh, tmp_path)[1])
    assert len(arrays["points"]) > 3 * len(mesh.points)
    means = np.abs(arrays["by mean"])[arrays["triangles"].reshape(-1, 3)]
    flat = np.array([type(surface).__name__ == "Plane" for surface in mesh.surfaces])[mesh.face_ids]
    assert 0 < flat.sum() < len(flat)
    np.testing.assert_allclose(means[~flat], 0.5, rtol=1e-3)
    np.testing.assert_allclose(means[flat], 0.0, atol=1e-9)


def test_quadratic_triangles_are_flat_ones_on_their_curves(tmp_path):
    mesh = sm.mesh(sm.load("sphere"), 0.8, order=2)
    contents, arrays = arrays_of(page_of(mesh, tmp_path)[1])
    points = arrays["points"].reshape(-1, 3) * contents["scale"] + contents["centre"]
    flat = arrays["facets"].reshape(-1, 3)
    parts = len(flat) // len(mesh.triangles)
    assert parts == 16 and flat.max() < len(points)
    weights = np.array(contents["weights"]).reshape(parts, 3, 3)
    straight = np.einsum("pkc,mcx->mpkx", weights, mesh.points[mesh.triangles])
    off = np.linalg.norm(points[flat.reshape(-1, parts, 3)] - straight, axis=-1)
    longest = np.linalg.norm(mesh.points[mesh.edges[:, 0]] - mesh.points[mesh.edges[:, 1]], axis=1)
    assert off.max() < 0.2 * longest.max()  # each near the place that its weights say
    assert np.ptp(np.linalg.norm(points, axis=1)) < 0.01 * contents["scale"]


def test_a_mesh_from_a_file_has_what_it_carries(tetrahedron, tmp_path):
    contents, _ = arrays_of(page_of(tetrahedron, tmp_path, by="quality")[1])
    assert [entry["key"] for entry in contents["colourings"]] == ["alpha", "angle", "face"]
    assert contents["by"] == "alpha"


def test_broken_meshes_have_a_report_too(saddle, tmp_path):
    triangles = saddle.triangles.copy()
    triangles[0] = triangles[1]
    text, _ = page_of(changed(saddle, triangles=triangles), tmp_path)
    assert "NOT CLEAN" in text and 'class="problem"' in text


def test_what_cannot_be_reported_is_refused(saddle, tetrahedron, tmp_path):
    with pytest.raises(FileFormatError, match=r"written as \.html"):
        html_report(saddle, tmp_path / "a.pdf")
    with pytest.raises(ValueError, match="cannot colour by 'size'"):
        html_report(tetrahedron, tmp_path / "a.html", by="size")
    with pytest.raises(ValueError, match="known are alpha"):
        html_report(tetrahedron, tmp_path / "a.html", by="colour")
    with pytest.raises(FileFormatError, match="does not exist"):
        html_report(saddle, tmp_path / "b" / "a.html")
    lost = saddle.points.copy()
    lost[3, 1] = np.nan
    with pytest.raises(FileFormatError, match="vertex 3 has no finite place"):
        html_report(changed(saddle, points=lost), tmp_path / "a.html")
    assert not list(tmp_path.iterdir())


def test_a_mesh_without_extent_has_a_report(tetrahedron, tmp_path):
    text, _ = page_of(changed(tetrahedron, points=np.ones((4, 3))), tmp_path)
    assert "NOT CLEAN" in text


def test_size_of_the_file(tmp_path):
    """Under 15 MB for 200 thousand triangles: so much a triangle, beside the viewer's own."""
    mesh = grid(Saddle(), 100, sizes=np.random.default_rng(0).uniform(0.01, 0.02, 101**2))
    noise = np.random.default_rng(1).normal(0, 1e-3, (101**2, 3))
    noisy = changed(mesh, points=mesh.points + noise)
    size = len(page_of(noisy, tmp_path)[0])
    empty = len(page_of(grid(Saddle(), 1), tmp_path)[0])
    assert empty + 200_000 * (size - empty) / len(mesh.triangles) < 15e6


@pytest.mark.parametrize("logarithmic", [False, True])
def test_histogram_counts_everything_once(logarithmic):
    values = np.r_[np.geomspace(1e-3, 10, 500), np.nan, 1e9, 1e-9]
    drawn = histogram(values, "a < b", (1e-3, 10), logarithmic)
    counts = [int(n.replace(",", "")) for n in re.findall(r": ([\d,]+)</title>", drawn)]
    assert sum(counts) == 502 and len(counts) <= BINS
    assert "a &lt; b" in drawn


def test_any_field_finds_a_place():
    shown = _table(
        {
            "plain": 1.0,
            "none": None,
            "flags": [True, False],
            "by_name": {"a": {"b": "<c>"}},
            "faces": [{"face": 0, "area": 2.5}, {"face": 1, "kind": "plane"}],
        }
    )
    for said in ("yes, no", "&lt;c&gt;", "<th>kind</th>", "faces (2)", "by name"):
        assert said in shown


# ---------------------------------------------------------------- in a browser


def chromium():
    """A Chromium of this machine; SURFMESH_BROWSER names another."""
    names = os.environ.get("SURFMESH_BROWSER", ""), "chromium", "chromium-browser", "google-chrome"
    return next((path for path in map(shutil.which, filter(None, names)) if path), None)


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    path = chromium()
    if path is None:
        pytest.skip("no Chromium on this machine (Debian: apt-get install chromium)")
    software = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
    with playwright.sync_playwright() as running:
        launched = running.chromium.launch(executable_path=path, args=software)
        yield launched
        launched.close()


@pytest.fixture
def opened(browser):
    """Open a file without a network; ``faults`` collects what the page complains about."""
    context = browser.new_context(viewport={"width": 1000, "height": 700}, offline=True)
    faults = []

    def open_page(path):
        page = context.new_page()
        page.set_default_timeout(20_000)
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.on("console", lambda said: said.type == "error" and faults.append(said.text))
        page.on("requestfailed", lambda request: faults.append(request.url))
        page.goto(path.as_uri())
        page.wait_for_selector("html[data-ready=yes]")
        return page

    yield open_page, faults
    context.close()


def picture(page):
    """Pixels of the view, after what was asked for has been drawn."""
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 60)))")
    box = page.locator("#canvas").bounding_box()
    return imread(BytesIO(page.screenshot(clip=box)))[..., :3]


def coloured(pixels):
    return float((np.ptp(pixels, axis=-1) > 0.1).mean())


def test_a_browser_shows_turns_and_picks(opened, tmp_path):
    mesh = icosphere(3)
    mesh = changed(mesh, sizes=np.full(len(mesh.points), 0.15))
    open_page, faults = opened
    page = open_page(html_report(mesh, tmp_path / "sphere.html", name="ball"))
    assert "ball" in page.title() and page.inner_text("#verdict") == "clean"

    first = picture(page)
    assert coloured(first) > 0.1
    box = page.locator("#canvas").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    page.mouse.move(x, y)
    page.wait_for_selector("#pointer:not([hidden])")
    said = page.inner_text("#pointer")
    assert "face: 0 (sphere)" in said and "alpha" in said
    page.mouse.click(x, y)
    rows = dict(line.split("\t") for line in page.inner_text("#picked-text").splitlines())
    assert 0 <= int(rows["triangle"]) < len(mesh.triangles) and rows["face"] == "0 (sphere)"
    place = np.array([float(value) for value in rows["point (model units)"].split(",")])
    assert np.linalg.norm(place) == pytest.approx(1, abs=0.02)
    corners = mesh.points[mesh.triangles[int(rows["triangle"])]]
    assert np.linalg.norm(place - corners.mean(axis=0)) < 0.1  # the one under the pointer

    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 120, y + 40, steps=4)
    page.mouse.up()
    page.mouse.move(box["x"] + 3, box["y"] + box["height"] - 3)
    turned = picture(page)
    assert np.abs(turned - first).max(axis=-1).mean() > 0.01

    page.mouse.move(x, y)
    page.mouse.wheel(0, 400)
    page.mouse.move(box["x"] + 3, box["y"] + box["height"] - 3)
    assert abs(coloured(picture(page)) - coloured(turned)) > 0.02

    before = picture(page)
    page.get_by_label("circles").check()
    circled = picture(page)
    assert np.abs(circled - before).max(axis=-1).mean() > 0.01
    page.select_option("#by", label="face")
    assert page.inner_text("#bar-title") == "face number"
    assert np.abs(picture(page) - circled).max(axis=-1).mean() > 0.01

    page.locator("button[data-triangle]").first.click()
    number = page.locator("button[data-triangle]").first.inner_text()
    assert page.inner_text("#picked-text td >> nth=0") == number
    assert coloured(picture(page)) > 0.1
    assert faults == []


def test_a_browser_opens_what_is_not_clean(opened, moebius_band, tmp_path):
    open_page, faults = opened
    page = open_page(html_report(moebius_band, tmp_path / "band.html"))
    assert page.inner_text("#verdict") == "NOT CLEAN" and not check(moebius_band).clean
    assert coloured(picture(page)) > 0.01
    assert faults == []


def test_ellipses_where_sizes_have_a_direction(opened, tmp_path):
    rod = sm.ParametricSurface("cos(u)", "sin(u)", "v", u=(0, "2*pi"), v=(0, 4))
    mesh = sm.mesh(rod, sm.Sizing(chord=0.01, anisotropy=6))
    open_page, faults = opened
    page = open_page(html_report(mesh, tmp_path / "rod.html"))
    before = picture(page)
    page.get_by_label("circles").check()
    assert np.abs(picture(page) - before).max(axis=-1).mean() > 0.01 and not faults


def test_curved_triangles_are_picked_whole_beside_the_tools(opened, tmp_path):
    mesh = sm.mesh(sm.load("sphere"), 0.8, order=2)
    named = mesh.replaced(groups=replace(mesh.groups, face_names=("ball's skin",)))
    open_page, faults = opened
    page = open_page(html_report(named, tmp_path / "ball.html", by="face"))
    assert page.inner_text("#bar-names").strip() == "0: ball's skin"
    tools, box, bar = (
        page.locator(name).bounding_box() for name in ("#tools", "#canvas", "#bar")
    )  # fmt: skip
    assert tools["y"] + tools["height"] <= box["y"] and box["y"] + box["height"] <= bar["y"]
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.click(x, y)
    rows = dict(line.split("\t") for line in page.inner_text("#picked-text").splitlines())
    assert 0 <= int(rows["triangle"]) < len(mesh.triangles)
    place = np.array([float(value) for value in rows["point (model units)"].split(",")])
    assert np.linalg.norm(place) == pytest.approx(1, abs=0.02)  # straight ones lie 0.1 deeper
    corners = mesh.points[mesh.triangles[int(rows["triangle"])]]
    assert np.linalg.norm(place - corners.mean(axis=0)) < 0.6
    page.get_by_label("circles").check()
    page.get_by_label("light").check()
    assert coloured(picture(page)) > 0.1 and faults == []


def test_the_table_of_faces_has_what_was_promised(tmp_path):
    import cadquery as cq

    part = cq.Workplane().box(10, 20, 30).edges("|Z and >X and >Y").fillet(2)
    mesh = sm.mesh(part, {"*": sm.Sizing(angle=5), "type:cylinder": {"min_size": 1.0}})
    text = html_report(mesh, tmp_path / "part.html").read_text(encoding="utf-8")
    table = text[text.index("<summary>Faces</summary>") :]
    assert "<th>angle °</th>" in table and "<th>stated limit</th>" in table
    assert "min_size 1 keeps face" in table and '<td class="number">5</td>' in table


def test_the_table_of_faces_has_no_rounding(tmp_path):
    import cadquery as cq

    box = cq.Workplane().box(3, 2, 1).rotate((0, 0, 0), (1, 2, 3), 33)
    text = html_report(sm.mesh(box, 0.5), tmp_path / "box.html").read_text(encoding="utf-8")
    table = text[text.index("<summary>Faces</summary>") :]
    assert not re.search(r"\de-\d\d", table[: table.index("</table>")])

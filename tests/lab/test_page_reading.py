"""What the page says of a motion, and how a reader changes the case, in a real browser."""

import io
import math
import re
import zipfile

import pytest
from tests.lab.browser import enter, new_page, open_sections, shown

from stylobate.lab.options import presets

PRESETS = {preset.identity: preset for preset in presets()}
STATE = "window.stylobate.state()"
ANSWER = "window.stylobate.laboratory.answer"


def test_the_note_under_the_curves_names_the_model_that_they_are_of(page):
    note = page.locator(".response > .note")
    own, others = re.compile("^Steady rolling, in closed form"), re.compile("^Steady rolling of a slender column")
    model = page.get_by_label("Model", exact=True)
    for kind, told in (("wobbling", others), ("slender", own)):
        model.select_option(kind)
        note.filter(has_text=told).wait_for()


def test_a_refusal_stands_beside_its_field_and_over_the_stage(page):
    field = page.locator(".controls input.number[id^='damping']").first
    field.fill("-1")
    line = "damping must be zero or positive"
    page.locator(".old-note").get_by_text(line).wait_for()
    described = page.locator(f"#{field.get_attribute('aria-describedby')}")
    assert line in described.inner_text()
    field.fill("0.1")
    page.locator(".old-note").wait_for(state="hidden")
    described.wait_for(state="hidden")


def test_a_column_that_will_overturn_is_not_called_overturned_before_and_its_fall_is_marked(page):
    page.get_by_label("Preset").select_option(PRESETS["averaging-fails"].title)
    page.wait_for_function(f"() => {ANSWER}.outcome === 'OVERTURNED'")
    shown(page)
    badge, fall = page.locator(".badge.overturned"), page.get_by_text("from here on: not computed")
    page.evaluate("() => { const { clock } = window.stylobate.laboratory; clock.pause(); clock.seek(0.5); }")
    assert badge.inner_text().startswith("Will overturn at ")
    assert not fall.is_visible()
    page.evaluate("() => { const { clock } = window.stylobate.laboratory; clock.seek(clock.to); }")
    assert badge.inner_text() == "Overturned"
    assert fall.is_visible()
    tilt = page.evaluate("() => Math.hypot(...window.stylobate.stage.pose().tilt)")
    assert tilt == pytest.approx(3.14159265 / 2, abs=1e-6)  # its side lies on the base


def test_the_frequency_is_dragged_along_the_branch_and_the_way_back_leads_to_where_it_was(page):
    marker = page.get_by_role("slider", name="Angular frequency of the base motion")
    start = page.evaluate(f"() => {STATE}.description.tilt")
    marker.press("Shift+ArrowLeft")
    page.wait_for_function(f"() => {STATE}.description.tilt[0] !== {start[0]}")
    shown(page)
    lower = page.evaluate(f"() => {STATE}.description.motion.angular_frequency")
    assert lower < 1.6
    assert page.evaluate(f"() => {ANSWER}.outcome") == "ROLLING"
    assert page.get_by_text("changed").is_visible()
    page.go_back()
    page.wait_for_function(f"() => {STATE}.description.motion.angular_frequency === 1.8")
    page.get_by_label("Start", exact=True).select_option("standing")
    page.wait_for_function(f"() => {ANSWER}.outcome === 'AT_REST'")


def test_straight_shaking_is_followed_along_the_upper_branch_and_back(page):
    page.get_by_label("Preset", exact=True).select_option("line-strong")
    page.wait_for_function(f"() => {STATE}.description.motion.kind === 'straight'")
    shown(page)
    begun, turns = (
        page.evaluate(f"() => {what}") for what in (f"{STATE}.description.tilt", f"{ANSWER}.measures.turns")
    )
    for frequency in (2.5, 2.0, 1.9, 3.0):
        before = page.evaluate(f"() => {STATE}.description.tilt[0]")
        page.locator(".controls input.number[id^='angular_frequency']").first.fill(str(frequency))
        page.wait_for_function(f"() => {STATE}.description.tilt[0] !== {before}")
        shown(page)
        assert page.evaluate(f"() => [{ANSWER}.outcome, {ANSWER}.warnings]") == ["ROLLING", []]
    assert page.evaluate(f"() => {STATE}.description.tilt") == pytest.approx(begun, rel=2e-8)
    assert page.evaluate(f"() => {ANSWER}.measures.turns") == pytest.approx(turns, rel=1e-6)


def test_a_start_on_an_unstable_orbit_is_named_so_and_still_is_when_the_length_changes(page):
    page.get_by_label("Preset", exact=True).select_option("line-strong")
    page.wait_for_function(f"() => {STATE}.description.motion.kind === 'straight'")
    shown(page)
    remark = page.locator(".verdict .warning").filter(has_text="Start: the exact orbit is unstable")
    page.locator(".controls input.number[id^='angular_frequency']").first.fill("1.4")
    remark.wait_for()
    page.locator(".controls input.number[id^='duration']").first.fill("30")
    page.wait_for_function(f"() => {STATE}.description.duration === 30 && {ANSWER}.thresholds")
    page.wait_for_function(f"() => {ANSWER}.toml.includes('duration = 30')")
    assert remark.is_visible()


def component(name, title):
    """Return a file with one component of a record, as a reader chooses it."""
    header = f"PEER NGA STRONG MOTION DATABASE RECORD\n{title}\nACCELERATION IN UNITS OF G\nNPTS= 100, DT= .02 SEC\n"
    values = "\n".join(f"{0.1 * math.sin(0.3 * place):.6e}" for place in range(100))
    return {"name": name, "mimeType": "text/plain", "buffer": (header + values).encode()}


def test_a_record_of_two_stations_or_of_one_component_is_remarked_on(page):
    page.get_by_label("Base motion", exact=True).select_option("record")
    chosen, beside = page.locator("input[type=file]"), page.locator(".record .warning")
    files = [component("a_000.AT2", "Quake, 1/2/1990, Here, 0"), component("b_090.AT2", "Quake, 1/2/1990, There, 90")]
    chosen.set_input_files(files=files)
    beside.filter(has_text="different events or stations").wait_for()
    page.locator(".verdict .warning").filter(has_text="different events or stations").wait_for()
    chosen.set_input_files(files=files[:1])
    beside.filter(has_text="one horizontal component (a_000.AT2)").wait_for()
    page.wait_for_function(f"() => {ANSWER}.warnings.every((line) => !line.includes('stations'))")


DROP = """([name, bytes]) => {
    const carried = new DataTransfer();
    carried.items.add(new File([new Uint8Array(bytes)], name));
    const drop = new DragEvent("drop", { dataTransfer: carried, bubbles: true, cancelable: true });
    document.querySelector(".record .own-record").dispatchEvent(drop);
}"""


def test_the_records_of_an_archive_are_choices(page):
    page.get_by_label("Base motion", exact=True).select_option("record")
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for number, ways in ((1, ("000", "090")), (2, ("000",))):
            for way in ways:
                file = component(f"RSN{number}_Q_A{way}.AT2", f"Quake, 1/2/1990, Place {number}, {way}")
                archive.writestr(file["name"], file["buffer"])
    held = [*content.getvalue()]
    chosen, records = page.locator("input[type=file]"), page.get_by_label("Record in the archive")
    chosen.set_input_files(files=[{"name": "PEER.zip", "mimeType": "application/zip", "buffer": bytes(held)}])
    page.locator(".record .hint").get_by_text("RSN1_Q_A: 100 samples").wait_for()
    assert records.locator("option").all_inner_texts() == ["RSN1_Q_A", "RSN2_Q_A"]
    page.wait_for_function(f"() => {ANSWER}.python.includes('PEER.zip/RSN1_Q_A090.AT2')")
    records.select_option("RSN2_Q_A")
    page.locator(".record .warning").filter(has_text="one horizontal component").wait_for()
    page.wait_for_function(f"() => {ANSWER}.python.includes('PEER.zip/RSN2_Q_A000.AT2')")
    page.evaluate(DROP, ["dropped.zip", held])
    page.wait_for_function(f"() => {ANSWER}.python.includes('dropped.zip/RSN1_Q_A000.AT2')")
    assert records.input_value() == "RSN1_Q_A"
    one = component("b_090.AT2", "Quake, 1/2/1990, There, 90")
    chosen.set_input_files(files=[one])
    page.wait_for_function(f"() => {ANSWER}.python.includes('b_090.AT2')")
    assert records.is_hidden()


MOVED = """() => {
    const acceleration = (time) => ({ x: 3 * Math.sin(6 * time), y: 0.5, z: 9.8 });
    const begun = performance.now();
    window.moving = setInterval(() => {
        const accelerationIncludingGravity = acceleration((performance.now() - begun) / 1000);
        window.dispatchEvent(new DeviceMotionEvent("devicemotion", { accelerationIncludingGravity }));
    }, 20);
}"""


def test_a_phone_that_is_moved_gives_a_record_and_one_without_a_sensor_says_so(browser, address):
    context = browser.new_context(viewport={"width": 390, "height": 840}, has_touch=True)
    page = new_page(context)
    enter(page, address, "#case=temple")
    shown(page)
    open_sections(page)
    move = page.get_by_role("button", name="Move this phone…")
    move.click()
    page.locator(".record .problem").get_by_text("This device does not report its motion.").wait_for()
    page.evaluate(MOVED)
    move.click()
    page.get_by_role("button", name="Tilt and shake it").wait_for()
    page.locator(".record .hint").get_by_text("phone: ").wait_for()
    page.wait_for_function(f"() => {ANSWER}.toml.includes('phone.csv')")
    assert page.locator(".record .problem").is_hidden()
    shaken = page.evaluate(f"() => {ANSWER}.series.base_acceleration")
    along = [x for x, _, _ in shaken]
    assert 4.0 < max(along) - min(along) < 6.1  # of 3 m/s² to both sides, as often as a busy machine reports it
    assert max(abs(y) for _, y, _ in shaken) < 0.01  # what it feels from the beginning on counts as level
    context.close()


def test_a_machine_without_a_touch_screen_offers_no_phone(page):
    page.get_by_label("Base motion", exact=True).select_option("record")
    assert page.get_by_role("button", name="Move this phone…").is_hidden()

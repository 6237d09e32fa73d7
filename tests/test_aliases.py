"""Words of users for the numbers of a column: each has one meaning, in any writing."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stylobate.aliases import ALIASES, AMBIGUOUS, may_mean, meant_by, words_of
from stylobate.cli.main import run
from stylobate.earthquakes.inventories.headings import column_numbers
from stylobate.models.declared import model_quantities
from stylobate.text import did_you_mean

LISTED = [(alias, name) for name, aliases in ALIASES.items() for alias in (name, *aliases)]


def test_aliases_are_of_declared_numbers_and_of_the_words_of_a_table():
    assert set(ALIASES) <= {*column_numbers(), *model_quantities(), "name", "site", "shape", "profile"}


@given(st.sampled_from(LISTED), st.sampled_from((str.upper, str.title, str.lower)), st.sampled_from("_-. "))
def test_case_and_separators_of_an_alias_do_not_count(one, changed, separator):
    alias, name = one
    assert meant_by(changed(alias.replace(" ", separator))) == name


def test_no_alias_says_twice_what_another_one_says():
    for name, aliases in ALIASES.items():
        keys = [frozenset(words_of(one)) - {"of", "the"} for one in (name, *aliases)]
        assert len(set(keys)) == len(keys), name


def test_the_guide_lists_all_aliases():
    guide = (Path(__file__).parents[1] / "docs" / "how-to" / "inventory.md").read_text(encoding="utf-8")
    for name, aliases in ALIASES.items():
        assert not aliases or f"| `{name}` | {', '.join(aliases)} |" in guide, name


def test_an_ambiguous_word_is_never_read_and_lists_its_meanings():
    for word, names in AMBIGUOUS.items():
        assert (meant_by(word), may_mean(word)) == (None, names), word


def test_words_in_another_order_and_american_spelling_mean_the_same():
    same = ("height of the centre of mass", "Center-of-mass height", "centre of mass, height", "COM", "c.o.g.")
    assert {meant_by(text) for text in same} == {"mass_height"}


@pytest.mark.parametrize(
    ("given", "meant"),
    [("weight", "mass"), ("wieght", "mass"), ("foot_radius", "radius"), ("width", "radius")],
)
def test_suggestions_know_the_aliases(given, meant):
    known = ("height", "mass", "radius", "top_radius")
    assert did_you_mean(given, known) == f"did you mean {meant}?"


def test_a_misspelt_option_gets_the_number_that_its_word_means(capsys):
    assert run(["simulate", "--weight", "3"]) == 2
    assert "No such option '--weight'. Did you mean '--mass'?" in capsys.readouterr().err

"""A page as its tests see it: the elements, and the JSON in them."""

import html.parser
import json
import pathlib
import subprocess

VOID = {"meta", "link", "input", "img", "br", "hr"}


class Page(html.parser.HTMLParser):
    """Elements as (tag, attributes), texts of those with an id, and whether tags are balanced."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.text, self.elements, self.texts = text, [], {}
        self.open, self.balanced = [], True
        self.title, self.unnamed = "", []  # controls without a label
        self.feed(text)
        self.close()
        self.balanced = self.balanced and not self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.elements.append((tag, attributes))
        if tag in ("select", "input") and "aria-label" not in attributes and "label" not in [t for t, _ in self.open]:
            self.unnamed.append(attributes)
        if tag not in VOID:
            self.open.append((tag, attributes.get("id")))

    def handle_endtag(self, tag):
        if not self.open or self.open[-1][0] != tag:
            self.balanced = False
            return
        self.open.pop()

    def handle_data(self, data):
        if self.open and self.open[-1][0] == "title":
            self.title += data
        for _, identity in self.open:
            if identity:
                self.texts[identity] = self.texts.get(identity, "") + data

    def tags(self, tag):
        return [attributes for name, attributes in self.elements if name == tag]

    def of_class(self, word):
        return [attributes for _, attributes in self.elements
                if word in (attributes.get("class") or "").split()]

    def json(self, identity):
        def refuse(constant):
            raise ValueError(f"{constant} is no JSON")
        return json.loads(self.texts[identity], parse_constant=refuse)


def write(program, kind, folder):
    """Path of the page that write_page makes."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([program, kind, str(folder / kind)], check=True)
    return folder / kind / "page.html"


def report(facts):
    """Prints TAP; the exit status."""
    print(f"1..{len(facts)}")
    for number, (fact, holds) in enumerate(facts.items(), 1):
        print(f"{'ok' if holds else 'not ok'} {number} - {fact}")
    return 0 if all(facts.values()) else 1

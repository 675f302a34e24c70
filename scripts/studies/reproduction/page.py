"""Reports of tables, plots and sentences, as Markdown and as a page that holds its plots."""

import csv
import dataclasses
import html

import report


@dataclasses.dataclass
class Heading:
    text: str

    def markdown(self):
        return f"## {self.text}\n"

    def html(self):
        return f"<h2>{html.escape(self.text)}</h2>\n"


@dataclasses.dataclass
class Text:
    text: str

    def markdown(self):
        return self.text + "\n"

    def html(self):
        return f"<p>{html.escape(self.text)}</p>\n"


@dataclasses.dataclass
class Items:
    items: list

    def markdown(self):
        return "".join(f"- {item}\n" for item in self.items)

    def html(self):
        return "<ul>" + "".join(f"<li>{html.escape(i)}</li>\n" for i in self.items) + "</ul>\n"


@dataclasses.dataclass
class Figure:
    """An SVG that is also in a file of its own."""
    name: str
    title: str
    svg: str

    def markdown(self):
        return f"![{self.title}]({self.name}.svg)\n"

    def html(self):
        return f"<figure>{self.svg[self.svg.index('<svg'):]}</figure>\n"


class Report:
    """`folder`: of all files. `tools`: of plot_svg."""

    def __init__(self, title, folder, tools):
        self.title, self.folder, self.tools = title, folder, tools
        self.blocks, self.files = [], []

    def add(self, block):
        self.blocks.append(block)

    def plot(self, name, plot):
        tool = self.tools / "plot_svg"
        self.files += [f"{name}.{kind}" for kind in plot.save(tool, self.folder / name)]
        svg = (self.folder / f"{name}.svg").read_text(encoding="utf-8")
        self.add(Figure(name, plot.title, svg))

    def picture(self, name, title, svg):
        self.text(f"{name}.svg", svg)
        self.add(Figure(name, title, svg))

    def csv(self, name, head, rows):
        with open(self.folder / name, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([head, *rows])
        self.files.append(name)

    def text(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        self.files.append(name)

    def save(self):
        """Writes report.md and index.html."""
        markdown = f"# {self.title}\n\n" + "\n".join(b.markdown() for b in self.blocks)
        self.text("report.md", markdown)
        page = ("<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
                f"<title>{html.escape(self.title)}</title><style>{report.STYLE}</style></head>"
                f"<body><h1>{html.escape(self.title)}</h1>\n"
                + "".join(b.html() for b in self.blocks) + "</body></html>\n")
        self.text("index.html", page)

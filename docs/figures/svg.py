"""The few shapes that the documentation's figures need. Colors are Okabe and Ito's, as on the report page."""

from html import escape

INK, SOFT, LINE = "#1b1b1b", "#5a5a5a", "#dddddd"
ORANGE, BLUE, GREEN, GREY = "#d55e00", "#0072b2", "#009e73", "#888888"
FONT = "system-ui, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif"


def short(value):
    """A coordinate with no more digits than a screen shows."""
    return f"{value:.2f}".rstrip("0").rstrip(".")


class Drawing:
    def __init__(self, width, height, title):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'font-family="{FONT}" font-size="12" role="img">',
            f"<title>{escape(title)}</title>",
            f'<rect width="{width}" height="{height}" fill="#fff"/>',
        ]

    def add(self, part):
        self.parts.append(part)

    def text(self, x, y, words, anchor="start", color=INK, turn=0, bold=False):
        turned = f' transform="rotate({turn} {short(x)} {short(y)})"' if turn else ""
        weight = ' font-weight="600"' if bold else ""
        self.add(
            f'<text x="{short(x)}" y="{short(y)}" text-anchor="{anchor}" fill="{color}"{weight}{turned}>{escape(words)}</text>'
        )

    def stroke(self, x1, y1, x2, y2, color, width=1.0, dash=None):
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        self.add(
            f'<path d="M{short(x1)} {short(y1)}L{short(x2)} {short(y2)}" stroke="{color}" stroke-width="{width}"{dashed}/>'
        )

    def rectangle(self, x, y, width, height, fill, stroke="none"):
        self.add(
            f'<rect x="{short(x)}" y="{short(y)}" width="{short(width)}" height="{short(height)}" fill="{fill}" stroke="{stroke}"/>'
        )

    def mark(self, x, y, shape, color):
        x, y = short(x), short(y)
        if shape == "dot":
            self.add(f'<circle cx="{x}" cy="{y}" r="1.8" fill="{color}" fill-opacity=".6"/>')
        elif shape == "node":
            self.add(f'<circle cx="{x}" cy="{y}" r="6.5" fill="{color}" fill-opacity=".35" stroke="{color}"/>')
        elif shape == "cross":
            self.add(
                f'<path d="M{x} {y}m-3.5-3.5l7 7m0-7l-7 7" stroke="{color}" stroke-width="1.6" fill="none"/>'
            )
        else:
            inside = {"disc": color, "ring": "#fff", "half": color}[shape]
            opacity = ' fill-opacity=".35"' if shape == "half" else ""
            self.add(f'<circle cx="{x}" cy="{y}" r="4" fill="{inside}"{opacity} stroke="{color}" stroke-width="1.4"/>')

    def panel(self, x, y, width, height, x_limits, y_limits):
        return Panel(self, x, y, width, height, x_limits, y_limits)

    def write(self, path):
        path.write_text("\n".join(self.parts + ["</svg>"]) + "\n")


class Panel:
    """A rectangle of the drawing with axes of its own."""

    def __init__(self, drawing, x, y, width, height, x_limits, y_limits):
        self.drawing, self.x, self.y, self.width, self.height = drawing, x, y, width, height
        self.x_limits, self.y_limits = x_limits, y_limits

    def across(self, value):
        low, high = self.x_limits
        return self.x + self.width * (value - low) / (high - low)

    def up(self, value):
        low, high = self.y_limits
        return self.y + self.height * (high - value) / (high - low)

    def frame(self, x_ticks, y_ticks, x_labels=True, y_labels=True, x_lines=None, y_lines=None):
        for value in x_lines or x_ticks:
            self.vertical(value, LINE, 1)
        for value in y_lines or y_ticks:
            self.horizontal(value, LINE, 1)
        for value in x_ticks if x_labels else ():
            self.drawing.text(self.across(value), self.y + self.height + 15, short(value), "middle", SOFT)
        for value in y_ticks if y_labels else ():
            self.drawing.text(self.x - 6, self.up(value) + 4, short(value), "end", SOFT)
        self.drawing.rectangle(self.x, self.y, self.width, self.height, "none", "#444")

    def title(self, words, more):
        self.drawing.text(self.x, self.y - 7, words, bold=True)
        self.drawing.text(self.x + self.width, self.y - 7, more, "end", SOFT)

    def vertical(self, value, color, width, dash=None):
        at = self.across(value)
        self.drawing.stroke(at, self.y, at, self.y + self.height, color, width, dash)

    def horizontal(self, value, color, width, dash=None):
        at = self.up(value)
        self.drawing.stroke(self.x, at, self.x + self.width, at, color, width, dash)

    def band(self, low, high):
        self.drawing.rectangle(self.x, self.up(high), self.width, self.up(low) - self.up(high), "#eef3f6")

    def bar(self, left, right, height, color):
        x, y = self.across(left) + 1, self.up(height)
        self.drawing.rectangle(x, y, self.across(right) - 1 - x, self.y + self.height - y, color)

    def mark(self, x, y, shape, color):
        self.drawing.mark(self.across(x), self.up(y), shape, color)

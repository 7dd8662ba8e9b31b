"""What a terminal or a notebook shows: progress and tables."""
import html

from ._arguments import refuse


def progress_of(progress):
    """What C++ calls: `progress` itself, or for True a function that draws one bar of tqdm a phase."""
    if progress is not True:
        return progress or None
    try:
        from tqdm.auto import tqdm
    except ModuleNotFoundError:
        raise refuse("progress: True draws with tqdm, which is not installed", "the package python3-tqdm, or a function") from None
    bars = {}

    def show(phase, done, total, note):
        if phase not in bars:
            for earlier in bars.values():
                earlier.close()
            bars[phase] = tqdm(desc=phase, total=total)
        bar = bars[phase]
        bar.total, bar.n = total, done
        bar.set_postfix_str(note, refresh=False)
        bar.close() if done >= total else bar.refresh()
    return show


def html_table(heads, rows):
    """The text of each cell as it is."""
    def line(tag, cells):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
    return "<table>" + line("th", heads) + "".join(line("td", row) for row in rows) + "</table>"

"""Scripts in the percent format: cells that begin with `# %%`."""
import re


def cells(script):
    """(whether it is text, its content) of each cell; text in Markdown."""
    for kind, body in re.findall(r"^# %%(.*)\n((?:(?!# %%).*\n?)*)", script, re.M):
        is_text = kind.strip() == "[markdown]"
        yield is_text, re.sub(r"^# ?", "", body.strip(), flags=re.M) if is_text else body.strip()

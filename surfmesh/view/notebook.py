"""What ``show`` opens in a notebook: the view of the HTML report, within the page."""

from html import escape

HEIGHT = 640  # pixels


def show_in_notebook(page: str) -> None:
    """Display a whole HTML page as a widget; it needs no extension and no server."""
    from IPython.display import HTML, display

    style = f"width: 100%; height: {HEIGHT}px; border: 1px solid #d6dade"
    # may run its scripts and nothing else
    frame = f'<iframe sandbox="allow-scripts" style="{style}" srcdoc="{escape(page)}"></iframe>'
    display(HTML(f"<div>{frame}</div>"))

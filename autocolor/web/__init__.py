"""Pictures in a browser: a page that is one file, and a widget for notebooks.

It may use the wings up to `batches` and `journal`. Both hosts show the same export with the same module.
"""

"""The columns of tables: what each field is, told once, and all that derives from it.

Uses `errors` and `checks`.
"""

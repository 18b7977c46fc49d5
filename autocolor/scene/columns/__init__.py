"""The columns of tables: what each field is, told once, and all that derives from it.

Uses the ground alone.
"""

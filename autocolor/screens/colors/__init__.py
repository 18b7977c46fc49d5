"""Color mixing (Figure 13) and light blending (Figure 14).

Uses the session, the interface of screens, `input` and `picture`.
"""

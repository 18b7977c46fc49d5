"""Readers of mesh files that are other people's work to know: VTK, glTF, 3MF and the formats of solvers.

`reader` starts `worker` in a process of its own, where a module for each library reads the file, and takes
the `mesh` that comes back. Uses the modules of `files` and of `files.meshes`, `scene` and the ground.
"""

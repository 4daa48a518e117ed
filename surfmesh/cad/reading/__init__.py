"""CAD files, read in a child process with limits of time and memory.

read_file: reading a CAD file safely: in a child process with limits of processor time and memory.
collector: Python's collector of cycles, which would walk through new objects again and again.
ocp_import: the import of OCP, begun while something else is loaded.
readers: STEP, IGES and BREP files -> a tree of parts, by OCP's readers.
in_this_process: a CAD file read where it is asked for, by the child or by who trusts the file.
child: ``python -m surfmesh.cad.reading.child``: read one CAD file, hand the model back.
limits: how much a CAD file may cost to read: processor time and memory of the child that reads it.
lifeline: a child process that does not outlive its parent.
"""

"""CAD files, read in a child process with limits of time and memory.

read_file: reading a CAD file safely: in a child process with limits of processor time and memory.
readers: STEP, IGES and BREP files -> a tree of parts, by OCP's readers. Runs in a child process.
child: ``python -m surfmesh.cad.reading.child``: read one CAD file, hand the model back.
limits: how much a CAD file may cost to read: processor time and memory of the child that reads it.
lifeline: a child process that does not outlive its parent.
processor_clock: the timer of processor time in the process that reads a CAD file.
"""

"""CAD models as plain data. The only package that knows OCP, which it imports when it is needed.

In the order in which data passes; doors for others in brackets:

reading      STEP, IGES and BREP files, in a child process (read_file)
cadquery     objects of CadQuery, build123d and OCP (from_cadquery)
units        units of length by name
parts        what both hand over: a tree of parts with names, colours and places
sub_shapes   sub-shapes of OCP's shapes by kind and number, and how large they are
healing      parts mended, sewn and imprinted; every change is put in words
conversion   parts -> one model
model        the model, plain data without OCP, and what is true of it (all of it)
selection    faces, edges and solids of a model by name, number, colour or selector (selection)
"""

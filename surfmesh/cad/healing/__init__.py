"""What is mended before a shape becomes plain data: faults of files, loose and touching parts.

shape_healing: repair of what files get wrong, by OCP's shape healing; every change is put in words.
validity: whether OCP's checker finds nothing wrong with a shape.
creases: faces whose surface has creases inside are cut along them.
sphere_poles: spheres are turned where an edge passes a pole: there its p-curve in (u, v) leaps by
    half a turn.
joining: what is asked of bodies and faces that touch: sewing, imprinting, with their tolerances.
shell_bodies: closed shells become solids; one that looks inward within another is a void of that.
sewing: loose faces are joined along edges that lie within a tolerance; closed shells become solids.
imprinting: touching bodies share their faces: the general fuse of OCP, with all names carried
    along.
origins: what shapes were made of when bodies were imprinted or faces sewn, and the names that
    follow.
unusable_faces: faces that cannot be meshed, whatever the sizes, by name, place and reason.
"""

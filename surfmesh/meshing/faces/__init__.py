"""One face of a CAD model, and what is done where it is narrow, thin or faulty.

face_data: what a face of a CAD model is meshed from, and what becomes of it: plain arrays.
face_state: what is known of one face of a model between the rounds of meshing.
face_mesh: one face of a CAD model: plain arrays in, a mesh of the face or the reason for none out.
face_repair: faces whose boundary crosses itself in (u, v): taken apart in the plane, or closed
    in space.
face_parts: a face that falls into several pieces of (u, v): each is meshed alone, over its own box.
polygon_filling: a polygon in space closed by triangles between its corners, of least total area.
tube_limits: sizes that leave room for a tube: at least a few edges from a seam all the way round
    to it.
thin_tubes: tips and necks of a face so thin that no ring of wanted edges fits round them.
tube_triangles: the long triangles of thin tips and necks, put beside the mesh of what is left of
    a face.
strip_triangulation: faces without inside: triangles between the nodes of two sides that face
    each other.
inward_faces: faces whose sizes the core grows inward from their edges.
graded_faces: faces whose sizes the core finds from their curvature and their edges.
face_in_rows: a face's mesh that the core keeps in rows with others.
face_queue: ordinary faces, which the core meshes one after the other without the interpreter.
partitions: meshes of faces that stay in files which all workers see.
face_jobs: jobs of many faces, made when they are wanted.
face_workers: who meshes the faces: this thread, threads of this process, or any executor.
opposite_faces: two sides of a wall thinner than the chord: meshed once, so that they do not cross.
face_sizings: the size requests of each face of a model, and of the sources those that reach it.
crossing_segments: smaller sizes where the polygon of a face's boundary crosses itself and its
    curves do not.
"""

"""STEP, IGES and BREP files -> a tree of parts, by OCP's readers.

Names, colours and the assembly come from the document that OCP fills; lengths are brought to
millimetres by its readers.
"""

from __future__ import annotations

import re
from pathlib import Path

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.Interface import Interface_Static
from OCP.Message import Message_ProgressRange
from OCP.Quantity import Quantity_ColorRGBA
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TColStd import TColStd_SequenceOfAsciiString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import (
    XCAFDoc_ColorTool,
    XCAFDoc_ColorType,
    XCAFDoc_DocumentTool,
    XCAFDoc_ShapeTool,
)

from surfmesh.cad.conversion.contents_of_file import without_faces
from surfmesh.cad.conversion.model_of_parts import model_of
from surfmesh.cad.healing.joining import Joining
from surfmesh.cad.model.cad_model import CadModel, Colour
from surfmesh.cad.parts import Detail, Part, screen_colour
from surfmesh.errors import CadError

# names that programs make up for an instance; the name of what it is an instance of says more
MADE_UP = re.compile(r"(NAUO\d*|=>\[.*\]|\d+|NONE|COMPOUND|SOLID|SHELL|)", re.IGNORECASE)
# what OpenCASCADE writes for a shape that was given no name
NO_NAME = re.compile(r"Open CASCADE \w+ translator [\d. ]+")
UNIT_NAMES = {
    "millimetre": "mm", "millimeter": "mm", "mm": "mm", "centimetre": "cm", "cm": "cm",
    "metre": "m", "meter": "m", "m": "m", "inch": "in", "in": "in", "inches": "in", "foot": "ft",
    "ft": "ft", "feet": "ft", "micrometre": "um", "micron": "um", "um": "um",
}  # fmt: skip


def read_here(
    path: Path, heal: bool, units: str | None, joining: Joining | None = None
) -> CadModel:
    """Read a file in this process; a fault in OCP takes the process down.

    Raises CadError when it is not what its name says, or holds no faces.
    """
    reader = READERS[path.suffix.lower()]
    root, file_unit = reader(path)
    return model_of(
        root, heal=heal, units=units, file_unit=file_unit, source=path.name, joining=joining,
        path=path,
    )  # fmt: skip


def _step(path: Path) -> tuple[Part, str]:
    reader = STEPCAFControl_Reader()
    # the parameters exist only once a reader has been made
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    reader.SetGDTMode(False)  # dimensions, layers and views are of no use here
    reader.SetLayerMode(False)
    reader.SetViewMode(False)
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise CadError(f"{path.name} is not a STEP file, or is damaged")
    lengths, angles, solid_angles = (TColStd_SequenceOfAsciiString() for _ in range(3))
    reader.ChangeReader().FileUnits(lengths, angles, solid_angles)
    unit = lengths.Value(1).ToCString() if lengths.Length() else ""
    return _document(reader, path), UNIT_NAMES.get(unit.lower(), unit or "mm")


def _iges(path: Path) -> tuple[Part, str]:
    reader = IGESCAFControl_Reader()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    if reader.ReadFile(str(path)) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise CadError(f"{path.name} is not an IGES file, or is damaged")
    name = reader.IGESModel().GlobalSection().UnitName()
    unit = name.ToCString() if name is not None else ""
    return _document(reader, path), UNIT_NAMES.get(unit.lower(), unit or "mm")


def _brep(path: Path) -> tuple[Part, str]:
    """A BREP file knows no unit: millimetres."""
    shape = TopoDS_Shape()
    if not BRepTools.Read_s(shape, str(path), BRep_Builder()) or shape.IsNull():
        shape = TopoDS_Shape()
        if not BinTools.Read_s(shape, str(path)) or shape.IsNull():
            raise CadError(f"{path.name} is not a BREP file, or is damaged")
    return Part(path.stem, shape), "mm"


READERS = {
    ".step": _step, ".stp": _step, ".p21": _step, ".iges": _iges, ".igs": _iges,
    ".brep": _brep, ".brp": _brep,
}  # fmt: skip


def _document(reader: STEPCAFControl_Reader | IGESCAFControl_Reader, path: Path) -> Part:
    """Have the reader fill a document, and take its tree."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    if not reader.Transfer(document, Message_ProgressRange()):
        raise CadError(without_faces(path.name, None, path))
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    roots = TDF_LabelSequence()
    tool.GetFreeShapes(roots)
    parts = [_part(roots.Value(number + 1)) for number in range(roots.Length())]
    if not parts:
        raise CadError(without_faces(path.name, None, path))
    if len(parts) == 1:
        parts[0].name = parts[0].name or path.stem
        return parts[0]
    return Part(path.stem, children=parts)


def _part(label: TDF_Label) -> Part:
    """A part, or an assembly with all below it; an instance is placed where its parent is."""
    name, colour, place = _name(label), _colour(label), None
    target = label
    if XCAFDoc_ShapeTool.IsReference_s(label):
        target = TDF_Label()
        XCAFDoc_ShapeTool.GetReferredShape_s(label, target)
        location = XCAFDoc_ShapeTool.GetLocation_s(label)
        place = None if location.IsIdentity() else location
        if MADE_UP.fullmatch(name):
            name = _name(target)
        colour = colour or _colour(target)
    if XCAFDoc_ShapeTool.IsAssembly_s(target):
        components = TDF_LabelSequence()
        XCAFDoc_ShapeTool.GetComponents_s(target, components)
        children = [_part(components.Value(n + 1)) for n in range(components.Length())]
        return Part(name, None, place, colour, children=children)
    shape = XCAFDoc_ShapeTool.GetShape_s(target)
    return Part(name, shape, place, colour, _details(target))


def _details(label: TDF_Label) -> list[Detail]:
    labels = TDF_LabelSequence()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, labels)
    found = []
    for number in range(labels.Length()):
        sub = labels.Value(number + 1)
        name, colour = _name(sub), _colour(sub)
        if name or colour:
            found.append(Detail(XCAFDoc_ShapeTool.GetShape_s(sub), name, colour))
    return found


def _name(label: TDF_Label) -> str:
    if not label.IsAttribute(TDataStd_Name.GetID_s()):
        return ""
    name = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), name)
    found = str(name.Get().ToExtString()).strip()
    return "" if NO_NAME.fullmatch(found) else found


def _colour(label: TDF_Label) -> Colour | None:
    colour = Quantity_ColorRGBA()
    for kind in (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen):
        if XCAFDoc_ColorTool.GetColor_s(label, kind, colour):
            return screen_colour(colour.GetRGB())
    return None

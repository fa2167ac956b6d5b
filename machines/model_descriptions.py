"""What each key of the model file means, in a line: for the schema that editors read.

docs/model-file.md says more on each. The dimension and its unit are added from the field itself.
"""

from __future__ import annotations

#: Keys that mean the same in several tables.
_PLACED = {
    "position": "where the origin of the file's coordinates lies, global axes; zero by default",
    "axis": "global direction of the z axis of the file's coordinates; global z by default",
    "second_axis": "global direction that, made perpendicular to the axis, is their x axis",
}
_BY_DIRECTION = {
    "x": "along x",
    "y": "along y",
    "z": "along z",
    "rx": "about x",
    "ry": "about y",
    "rz": "about z",
}
_SPAN = {
    "from": "first value",
    "to": "last value",
    "points": "number of values, evenly spaced, both ends included; 5 by default",
}
_FLEXURE = {
    "material": "name of its material",
    "thickness": "least thickness, along the joint's y axis",
    "width": "width along the joint's z axis, about which it rotates; of a pivot, of each leaf",
    "bending": "beam, or plate where the width prevents anticlastic curvature; by default chosen "
    "from the proportions",
    "allowable_stress": "with which solve compares the largest equivalent stress",
    "stress_concentration": "factor on the stress of bending and of axial force; of notches by "
    "default Neuber's, otherwise 1",
}
_NOTCH_HEIGHT = "height of the parts beside the notches; by default these are cut to their middle"
_CASE = 'load case that it belongs to, "load" by default; loads of one case act together'
_FEW = "one joint; or joints"
_MANY = "several joints; or joint"

#: By table, as the classes of the schema are called, and key.
DESCRIPTIONS: dict[str, dict[str, str]] = {
    "ModelTable": {
        "title": "title of reports and tables",
        "gravity": "acceleration in global axes; makes a load case of the name gravity",
        "preload": "name of the load case under whose forces the structure vibrates",
        "materials": "isotropic materials by name",
        "sections": "cross-sections of beams by name",
        "flexures": "notch hinges, leaf springs and cross-spring pivots by name, for joints",
        "nodes": "places by name, [x, y, z] in global axes",
        "beams": "straight flexible links",
        "solids": "meshed parts, reduced to the nodes at which they meet the rest",
        "shapes": "outlines of bodies, for interference only",
        "bodies": "rigid bodies",
        "masses": "masses carried by nodes",
        "joints": "what connects two nodes at one place, direction by direction",
        "couplings": "gears, belts, chains and racks: one joint coordinate follows another",
        "springs": "elastic connections to the ground or between two nodes",
        "supports": "nodes held by the ground",
        "loads": "forces and moments at nodes",
        "line_loads": "forces per length over entire beams",
        "settlements": "known displacements of supports",
        "misfits": "gaps between the two sides of joints, closed by force",
        "tolerances": "tolerances of manufacturing",
        "force_limits": "the largest forces that joints may carry",
        "tool": "the tool centre point",
        "home": "joint coordinates in the configuration of the file, by joint and direction",
        "task": "task of the tool",
        "workspace": "poses that map and the report evaluate",
        "drives": "limits of the drives",
        "damping": "damping of the entire structure; give exactly one kind",
        "process": "milling cut whose stability the report states",
    },
    "MaterialTable": {
        "youngs_modulus": "Young's modulus",
        "poissons_ratio": "Poisson's ratio; or the shear modulus",
        "shear_modulus": "shear modulus; or Poisson's ratio",
        "density": "density; needed only where mass is needed",
        "loss_factor": "structural loss factor η, used where the file has no damping",
    },
    "RodTable": {"shape": "a solid circle", "diameter": "diameter"},
    "TubeTable": {
        "shape": "a hollow circle",
        "outer_diameter": "outer diameter",
        "inner_diameter": "inner diameter",
    },
    "RectangleTable": {
        "shape": "a solid rectangle",
        "width_y": "width along the beam's local y",
        "height_z": "height along the beam's local z",
    },
    "BoxTable": {
        "shape": "a hollow rectangle of one wall thickness",
        "width_y": "outer width along the beam's local y",
        "height_z": "outer height along the beam's local z",
        "thickness": "thickness of the walls",
    },
    "PropertiesTable": {
        "shape": "a section given by its properties",
        "area": "cross-sectional area",
        "Iy": "for bending in the local x-z plane",
        "Iz": "for bending in the local x-y plane",
        "J": "Saint-Venant's torsion constant: the polar moment for circles only",
        "shear_area_y": "effective area for shear along local y; both shear areas or none",
        "shear_area_z": "effective area for shear along local z; both shear areas or none",
    },
    "BeamTable": {
        "name": "name of the beam",
        "from": "node at which it begins",
        "to": "node at which it ends",
        "material": "name of its material",
        "section": "name of its section",
        "elements": "number of equal parts; 1 by default",
        "shear": "true (the default) for Timoshenko's theory, false for Euler-Bernoulli's",
        "orientation": "global direction in the local x-z plane, on the side of positive z",
        "offset_from": "rigid arm from its first node to its beginning, global axes",
        "offset_to": "rigid arm from its second node to its end, global axes",
    },
    "BodyTable": {
        "name": "name of the body",
        "nodes": "two nodes or more; a node lies in one rigid body at most",
        "mass": "its mass; none by default",
        "center_of_mass": "its place in global axes; the mean of the nodes by default",
        "inertia": "three rows of three about the centre of mass, global axes; zero by default",
    },
    "MassTable": {
        "node": "node that carries it",
        "mass": "its mass",
        "inertia": "three diagonal entries or three rows, global axes; zero by default",
    },
    "JointTable": {
        "name": "name of the joint",
        "type": "which directions are locked, in joint axes",
        "between": "two nodes at one place; motion and force are those of the second",
        "axis": "global direction of the joint's z axis: of rotation or of sliding",
        "second_axis": "global direction that, made perpendicular to the axis, is the x axis",
        "stiffness": "elastic directions, instead of locked or free",
        "damping": "viscous damping by direction",
        "driven": "actuated directions",
        "limits": "range of the joint's coordinates by direction, counted from home",
        "matrix": "of a bushing: six symmetric rows of six, instead of stiffness",
        "pitch": "of a helical joint: travel along the axis per right-handed turn",
        "flexure": "of a bushing: name of the flexure whose sizes give its stiffness",
    },
    "FlexureTable": _FLEXURE,
    "CircularNotchTable": {
        "shape": "a hinge of two circular notches",
        "radius": "radius of both notches",
        "height": _NOTCH_HEIGHT,
    }
    | _FLEXURE,
    "EllipticNotchTable": {
        "shape": "a hinge of two elliptic notches",
        "semi_axis_x": "semi-axis of both ellipses along the hinge",
        "semi_axis_y": "semi-axis of both ellipses across its thickness",
        "height": _NOTCH_HEIGHT,
    }
    | _FLEXURE,
    "LeafTable": {
        "shape": "a leaf spring",
        "length": "length along the joint's x axis between the clamped ends",
    }
    | _FLEXURE,
    "CrossSpringTable": {
        "shape": "a cross-spring pivot: leaves that cross without touching",
        "length": "length of each leaf between its clamped ends",
        "angle": "angle between the leaves; 90° by default",
        "crossing": "distance of the crossing from the first part along a leaf by its length; "
        "0.5 by default",
        "leaves": "2 (the default), or 3 with the outer ones half as wide",
        "spacing": "distance between the middles of neighbouring leaves along the joint's z axis; "
        "by default they touch",
    }
    | _FLEXURE,
    "SpringTable": {
        "name": "name of the spring; by default the names of its nodes",
        "node": "node that it ties to the ground; or between",
        "between": "two nodes that it connects; or node",
        "stiffness": "by direction, global axes",
    },
    "SupportTable": {
        "node": "node that is held",
        "fixed": 'a list of directions, or "all"',
    },
    "LoadTable": {
        "case": _CASE,
        "node": "node on which it acts",
        "force": "three components, global axes",
        "moment": "three components, global axes",
    },
    "LineLoadTable": {
        "case": _CASE,
        "beam": "beam on which it acts, from end to end",
        "force": "force per length, global axes; at the beginning where force_to is given",
        "force_to": "force per length at the end, between which it varies linearly",
    },
    "SettlementTable": {
        "case": _CASE,
        "node": "supported node",
        "displacement": "by direction, global axes",
    },
    "MisfitTable": {
        "case": _CASE,
        "joint": "joint whose sides do not meet",
        "gap": "by direction, joint axes: displacement of the second side that closes the joint",
    },
    "ToleranceTable": {
        "name": "name of the tolerance",
        "kind": "what deviates, in the words of ISO 1101",
        "joint": _FEW + ": what the feature carries",
        "joints": _MANY + ": what the feature carries",
        "size": "width or diameter of the zone; of a length half of its range",
        "slope": "of a tilt: half-angle of its cone, instead of size and length",
        "datum": "node of the feature about which it rotates, and whose body carries it",
        "axis": "global direction of the axis, of a surface's normal, or of a length",
        "along": "of a surface: global direction of its length",
        "length": "of the toleranced axis, or of a surface along its along",
        "width": "of a surface: width across",
        "limits": "of a length, instead of size: lower and upper deviation",
        "distribution": "distribution in the zone when sampled; uniform by default",
        "cost": "cost of the tolerance at the size given, for an allocation; 1 by default",
    },
    "ForceLimitTable": {
        "joint": _FEW,
        "joints": _MANY,
        "radial_force": "largest force across the joint's z axis",
        "axial_force": "largest force along the joint's z axis",
        "bending_moment": "largest moment across the joint's z axis",
        "torque": "largest moment about the joint's z axis",
        "static_rating": "static load rating (ISO 76), instead of radial_force",
        "safety_factor": "by which the rating is divided; 1 by default",
    },
    "ToolTable": {"tcp": "node at which compliance and stiffness are given"},
    "RayleighTable": {
        "alpha": "factor of the mass matrix",
        "beta": "factor of the stiffness matrix",
    },
    "DampingTable": {
        "modal_ratio": "damping ratio ζ of every mode",
        "loss_factor": "structural loss factor η; at resonance η = 2 ζ",
        "rayleigh": "C = alpha M + beta K",
    },
    "ProcessTable": {
        "diameter": "diameter of the cutter",
        "teeth": "number of teeth, equally spaced",
        "helix": "helix angle; 0 by default",
        "lead": "angle between the edge and the plane across the axis; 90° by default",
        "material": "material of the library of strutwork.cutting; or tangential",
        "tangential": "tangential force coefficient of the chip; or material",
        "radial": "radial force coefficient of the chip, beside tangential",
        "axial": "axial force coefficient of the chip, beside tangential",
        "source": "where the coefficients come from; needed with tangential",
        "immersion": "radial depth of cut by the diameter; 1, a slot, by default",
        "way": "up or down milling; down by default",
        "feed_per_tooth": "for removal rates; 0.1 mm by default",
        "axis": "axis of the tool from tip to holder, global, where the tool has not turned",
        "feed": "direction of the feed, global, where the tool has not turned; global x by default",
        "speeds": "spindle speeds",
        "modal_ratio": "damping ratio ζ of every mode, where the file has no damping",
    },
    "SpeedSpan": {
        "from": "least speed",
        "to": "largest speed",
        "points": "number of speeds, evenly spaced, both ends included; 51 by default",
    },
    "InterfaceTable": {
        "node": "node that is tied to the surface",
        "patch": "named patch of the mesh; or box",
        "box": "lowest and highest corner in the frame of the mesh; or patch",
        "normal": "of a box: direction in which its faces look, within 15°, frame of the mesh",
        "kind": "average (the default): forces spread over the patch; rigid: it moves as one",
    },
    "SolidTable": {
        "name": "name of the solid",
        "mesh": "mesh file beside the model file or below it; or step, surface, shape",
        "step": "STEP file that Gmsh fills with tetrahedra of edge cell",
        "surface": "closed surface (.stl, .obj, glTF) that Gmsh fills with tetrahedra of edge cell",
        "shape": "generated shape, with its sizes",
        "unit": 'of the coordinates in a mesh or surface file; "m" by default',
        "cell": "largest edge of a cell",
        "size": "of a block: along x, y and z",
        "envelope": "of an L-frame: width, depth, height",
        "plate": "of an L-frame: thickness of the upright plate",
        "base": "of an L-frame: thickness of the base",
        "inner_diameter": "of a tube",
        "outer_diameter": "of a tube",
        "length": "of a tube",
        "material": "name of the material of the entire solid; or materials",
        "materials": "name of the material of each region; or material",
        "order": "1 or 2 (the default): linear or quadratic displacements in each cell",
        "cutoff": "frequency above which no modes are retained; or modes",
        "modes": "number of modes retained with the interfaces held; or cutoff",
        "interfaces": "patches of the surface tied to nodes",
    }
    | _PLACED,
    "ShapeTable": {
        "body": "body, beam or solid that it moves with, or ground",
        "surface": "closed surface of one part (.stl, .obj, glTF)",
        "name": "name in messages; that of the body by default",
        "unit": 'of its coordinates; "m" by default',
    }
    | _PLACED,
    "TaskTable": {"directions": "directions of the tool that the machine is to move"},
    "CouplingTable": {
        "name": "name of the coupling",
        "between": "two joint coordinates JOINT:DIRECTION; the second follows the first",
        "ratio": "change of the second per change of the first; or per_turn",
        "per_turn": "of a rotation and then a translation: the travel per turn; or ratio",
    },
    "DriveTable": {
        "joint": _FEW,
        "joints": _MANY,
        "direction": "driven direction",
        "speed": "largest speed of a sliding drive",
        "turning_speed": "largest speed of a rotary drive",
        "force": "largest force of a sliding drive",
        "torque": "largest torque of a rotary drive",
        "resolution": "smallest step of a sliding drive",
        "angular_resolution": "smallest step of a rotary drive",
    },
    "LengthSpan": _SPAN,
    "AngleSpan": _SPAN,
    "StiffnessTable": _BY_DIRECTION,
    "DampingByDirection": _BY_DIRECTION,
    "Displacement": _BY_DIRECTION,
    "LimitsTable": _BY_DIRECTION,
    "WorkspaceTable": _BY_DIRECTION,
}

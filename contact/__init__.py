"""Rolling contacts: Hertz point and line contact, ball and roller bearings, profile rails."""

from strutwork.contact.angular import AngularContact
from strutwork.contact.bearing import Bearing, Geometry
from strutwork.contact.contacts import Contacts
from strutwork.contact.hertz import PointContact, ball_in_groove, point_contact
from strutwork.contact.law import STEEL, ContactLaw, Elastic, in_series
from strutwork.contact.line import line_contact
from strutwork.contact.rail import BallRail
from strutwork.contact.rollers import CylindricalRollers

__all__ = [
    "STEEL",
    "AngularContact",
    "BallRail",
    "Bearing",
    "ContactLaw",
    "Contacts",
    "CylindricalRollers",
    "Elastic",
    "Geometry",
    "PointContact",
    "ball_in_groove",
    "in_series",
    "line_contact",
    "point_contact",
]

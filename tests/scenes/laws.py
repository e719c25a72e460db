"""A blow as seen by others: its text, and its answer in the first one's terms.

A bar of cells strikes a rigid wall, or a bullet a plate whose middle is of
particles that fail. All that has a length, a direction, a speed or a stress goes
through a View.
"""
from scene_text import section


class View:
    """Lengths and times times @p length, densities and stresses times @p mass;
    all flies along with @p flight (m/s) and lies @p away (m); axis i of the
    first view is axes[i], against it where signs[i] is -1."""

    def __init__(self, length=1., mass=1., flight=(0., 0., 0.),
                 away=(0., 0., 0.), axes=(0, 1, 2), signs=(1, 1, 1),
                 is_reversed=False):
        self.length, self.mass, self.flight = length, mass, flight
        self.away, self.axes, self.signs = away, axes, signs
        self.is_reversed = is_reversed

    def turned(self, vector, signs=None):
        seen = [0., 0., 0.]
        for i in range(3):
            seen[self.axes[i]] = vector[i] * (signs or self.signs)[i]
        return seen

    def size(self, *vector):
        return ", ".join("%.17g mm" % (x * self.length)
                         for x in self.turned(vector, (1, 1, 1)))

    def place(self, *vector):
        return ", ".join("%.17g mm" % (x * self.length + 1e3 * a)
                         for x, a in zip(self.turned(vector), self.away))

    def speed(self, *vector):
        return ", ".join("%.17g m/s" % x for x in self.turned(
            [v + f for v, f in zip(vector, self.flight)]))

    def long(self, length):
        return "%.17g mm" % (length * self.length)

    def time(self, time):
        return "%.17g us" % (time * self.length)

    def metal(self, density, modulus, **more):
        return dict({"Density": "%.17g kg/m^3" % (density * self.mass),
                     "Young's modulus": "%.17g MPa" % (modulus * self.mass)},
                    **more)

    def aluminum(self):
        return self.metal(2700., 70e3, **{
            "Poisson's ratio": 0.33, "Model": "Johnson-Cook", "Johnson-Cook": {
                "Initial yield stress": "%.17g MPa" % (300. * self.mass),
                "Hardening modulus": "%.17g MPa" % (100. * self.mass),
                "Hardening exponent": 0.4, "Melt temperature": "900 K",
                "Specific heat": "900 J/kg/K"}})

    def scene(self, end, bodies, couplings):
        """@p end in us."""
        order = reversed if self.is_reversed else list
        top = {"End time": self.time(end),
               "List of bodies": ", ".join(order(list(bodies))),
               "List of couplings": ", ".join(order(list(couplings)))}
        sections = {"Materials": {"aluminum": self.aluminum(),
                                  "steel": self.metal(7800., 200e3)},
                    "Bodies": bodies, "Couplings": couplings}
        return ("".join("set %s = %s\n" % item for item in top.items()) +
                "".join(section(*item) for item in sections.items()))

    def numbers(self, result):
        """Energies, momenta per mass and strains of a result, seen by the
        first, with the scale in which they may differ."""
        energy = self.mass * self.length**3
        held = result["energy"]["internal"] / energy
        seen = {"steps": (result["steps"], 1.)}
        for name, joule in result["energy"].items():
            if name not in ("kinetic", "total", "external"):  # the observer's
                seen["energy " + name] = (joule / energy, held)
        for name, body in result["bodies"].items():
            for i in range(3):
                velocity = body["velocity"][self.axes[i]] * self.signs[i]
                seen["%s velocity %d" % (name, i)] = (
                    velocity - self.flight[i], 100.)
            for key in ("plastic_strain_max", "bonds_broken_fraction"):
                if key in body:
                    seen[name + " " + key] = (body[key], 1.)
        return seen


def bar_on_wall(view, end=6.):
    return view.scene(end, {
        "wall": {"Discretization": "rigid", "Motion": "prescribed",
                 "Size": view.size(16, 16, 2), "Center": view.place(0, 0, -1),
                 "Cell size": view.long(2), "Material": "steel",
                 "Initial velocity": view.speed(0, 0, 0)},
        "bar": {"Size": view.size(4, 4, 6),
                "Center": view.place(0.137, 0.053, 3.02),
                "Cell size": view.long(1), "Material": "aluminum",
                "Initial velocity": view.speed(0, 0, -300)}}, {
        "impact": {"Type": "contact", "Bodies": "bar, wall",
                   "Friction coefficient": 0.3}})


def bullet_on_zone(view, end=3., aside=0.137):
    """@p aside: mm along x by which the bullet is off the plate's middle."""
    plate = {"Material": "aluminum", "Center": view.place(0, 0, -1.5),
             "Initial velocity": view.speed(0, 0, 0)}
    return view.scene(end, {
        "plate": dict(plate, **{"Size": view.size(14, 14, 3),
                                "Cell size": view.long(1)}),
        "core": dict(plate, **{
            "Discretization": "SPG", "Carve from": "plate",
            "Size": view.size(8, 8, 3), "Nodal spacing": view.long(1),
            "Critical effective plastic strain": 0.2}),
        "bullet": {"Size": view.size(4, 4, 5),
                   "Center": view.place(aside, 0.053, 2.52),
                   "Cell size": view.long(1), "Material": "aluminum",
                   "Initial velocity": view.speed(0, 0, -600)}}, {
        "zone": {"Type": "tie", "Follower": "core", "Leader": "plate"},
        "impact": {"Type": "contact", "Bodies": "bullet, core, plate",
                   "Friction coefficient": 0.3},
        "debris": {"Type": "self-contact", "Bodies": "core",
                   "Friction coefficient": 0.3}})

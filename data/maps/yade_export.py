"""Text export of bodies and interactions from YADE for jamscope.

In a YADE script:

    exec(open("yade_export.py").read())
    jams = JamscopeExport("out", walls={"blade": blade_ids, "vessel": vessel_ids})
    O.engines += [PyRunner(command="jams.write()", iterPeriod=2000)]

and then   jamscope analyze out/*.csv --map yade.toml -o results   (or without the map: walls then have no shape).

walls: name -> ids of the facets, walls and boxes that make it up; every such body that spheres touch must be in one of them.
A name with "blade" in it is the blade, "vessel" or "wall" the vessel, unless a map says otherwise. SI units.

YADE's conventions, from its class reference and checked by the balance of forces: the normal of an interaction points from
id1 to id2, normalForce and shearForce act on id2; O.forces.f is without gravity, which the integrator adds.
"""


class JamscopeExport:
    def __init__(self, folder, walls, gravity=(0, 0, -9.81)):
        import os

        self.walls = {name: list(ids) for name, ids in walls.items()}
        self.wall_of = {i: name for name, ids in self.walls.items() for i in ids}
        self.start = {n: (Vector3(O.bodies[i[0]].state.pos), Quaternion(O.bodies[i[0]].state.ori)) for n, i in self.walls.items()}
        self.gravity = Vector3(gravity)
        os.makedirs(folder, exist_ok=True)
        headers = {
            "particles": "frame,time,id,x,y,z,radius,vx,vy,vz,wx,wy,wz,fx,fy,fz",
            "contacts": "frame,id1,id2,fn,ft_x,ft_y,ft_z,overlap",
            "wall_contacts": "frame,id,wall,fn,ft_x,ft_y,ft_z,px,py,pz,nx,ny,nz,overlap",
            "walls": "frame,wall,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz",
        }
        self.files = {}
        for name, header in headers.items():
            self.files[name] = open(os.path.join(folder, name + ".csv"), "w")
            self.files[name].write(header + "\n")

    def row(self, table, *values):
        flat = []
        for v in values:
            flat += list(v) if isinstance(v, Vector3) else [v]
        self.files[table].write(",".join(v if isinstance(v, str) else "%.9g" % v if isinstance(v, float) else str(v) for v in flat) + "\n")

    def write(self):
        frame, time = O.iter, float("%.12g" % O.time)
        for b in O.bodies:
            if isinstance(b.shape, Sphere):
                s = b.state
                total = O.forces.f(b.id) + s.mass * self.gravity
                self.row("particles", frame, repr(time), b.id, s.pos, b.shape.radius, s.vel, s.angVel, total)
        for i in O.interactions:
            if not i.isReal:
                continue
            a, b = i.id1, i.id2
            normal, shear = i.phys.normalForce, i.phys.shearForce  # on b
            fn = normal.dot(i.geom.normal)
            if a not in self.wall_of and b not in self.wall_of:
                self.row("contacts", frame, a, b, fn, -shear, i.geom.penetrationDepth)
                continue
            # The normal from the particle to the wall, the tangential force on the particle.
            ball, wall, n, ft = (b, a, -i.geom.normal, shear) if a in self.wall_of else (a, b, i.geom.normal, -shear)
            self.row("wall_contacts", frame, ball, self.wall_of[wall], fn, ft, i.geom.contactPoint, n, i.geom.penetrationDepth)
        # A wall moves as its first body does; its own frame is the laboratory's at the start.
        for name, ids in self.walls.items():
            s = O.bodies[ids[0]].state
            pos0, ori0 = self.start[name]
            turn = s.ori * ori0.conjugate()
            self.row("walls", frame, name, s.pos - turn * pos0, turn[3], turn[0], turn[1], turn[2], s.vel - s.angVel.cross(turn * pos0), s.angVel)
        for file in self.files.values():
            file.flush()

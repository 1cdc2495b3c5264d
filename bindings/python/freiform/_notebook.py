"""Views for notebooks: one HTML element that needs nothing from outside, and PNG."""
from __future__ import annotations

import base64
import html
from typing import Any

import numpy as np

from ._meshes import Mesh
from ._models import Model, TrimmedSurface
from ._patches import Surface
from ._refusals import Refusal
from ._triangles import TriangularPatch

_MAX_TRIANGLES = 20_000


def _mesh_of(what: Any) -> Mesh:
    """Within a thousandth of the size, for looking at."""
    from ._files import Document
    if isinstance(what, Mesh):
        return what
    if isinstance(what, TriangularPatch):
        what = Document([what])
    if isinstance(what, Document):
        model = what.scene()
    elif isinstance(what, Model):
        model = what
    else:
        assert isinstance(what, (Surface, TrimmedSurface))
        model = Model.assemble([what if isinstance(what, TrimmedSurface) else what.in_space()])
    box = model.summary().box
    size = float(np.linalg.norm(np.asarray(box.hi) - np.asarray(box.lo)))
    tolerance = size / 1000
    while True:
        mesh = model.tessellate(tolerance).mesh
        if len(mesh) <= _MAX_TRIANGLES or tolerance > size:
            return mesh
        tolerance *= 4


def html_of(what: Any) -> str:
    """The mesh in an <iframe> with its own script: it turns with the mouse. Nothing is fetched."""
    try:
        mesh = _mesh_of(what)
    except Refusal as refusal:
        return f"<pre>{html.escape(str(refusal))}</pre>"
    points, faces = mesh.points, mesh.faces
    if len(points) == 0:
        return "<pre>an empty mesh</pre>"
    lo, hi = points.min(axis=0), points.max(axis=0)
    scale = 2 / (float(np.linalg.norm(hi - lo)) or 1.0)
    p = ((points - (lo + hi) / 2) * scale).astype("<f4")

    def packed(a: Any) -> str:
        return base64.b64encode(a.tobytes()).decode()

    page = _PAGE.replace("@P@", packed(p)).replace("@F@", packed(np.ascontiguousarray(faces, dtype="<u4")))
    return f'<iframe srcdoc="{html.escape(page)}" width="640" height="400" style="border:0" sandbox="allow-scripts"></iframe>'


def png_of(what: Any) -> bytes | None:
    try:
        return _mesh_of(what).render_png(width=640, height=400)
    except Refusal:
        return None


_PAGE = """<!doctype html><meta charset="utf-8"><style>html,body{margin:0;height:100%}canvas{width:100%;height:100%}</style>
<canvas></canvas><script>
const raw=s=>Uint8Array.from(atob(s),c=>c.charCodeAt(0)).buffer;
const P=new Float32Array(raw("@P@")),F=new Uint32Array(raw("@F@")),n=F.length/3;
const c=document.querySelector("canvas"),g=c.getContext("2d");let az=-.7,el=.6,zoom=.9;
function draw(){const w=c.width=c.clientWidth*devicePixelRatio,h=c.height=c.clientHeight*devicePixelRatio;
const ca=Math.cos(az),sa=Math.sin(az),ce=Math.cos(el),se=Math.sin(el),s=Math.min(w,h)/2*zoom;
const m=P.length/3,X=new Float32Array(m),Y=new Float32Array(m),Z=new Float32Array(m);
for(let i=0;i<m;i++){const x=P[3*i],y=P[3*i+1],z=P[3*i+2],d=x*ca+y*sa;
X[i]=y*ca-x*sa;Y[i]=z*ce-d*se;Z[i]=d*ce+z*se;}
const order=Array.from({length:n},(_,i)=>i),depth=new Float32Array(n);
for(let i=0;i<n;i++)depth[i]=Z[F[3*i]]+Z[F[3*i+1]]+Z[F[3*i+2]];
order.sort((a,b)=>depth[a]-depth[b]);g.fillStyle="#f4f6f8";g.fillRect(0,0,w,h);
for(const i of order){const a=F[3*i],b=F[3*i+1],d=F[3*i+2];
const ux=X[b]-X[a],uy=Y[b]-Y[a],uz=Z[b]-Z[a],vx=X[d]-X[a],vy=Y[d]-Y[a],vz=Z[d]-Z[a];
let nx=uy*vz-uz*vy,ny=uz*vx-ux*vz,nz=ux*vy-uy*vx;const l=Math.hypot(nx,ny,nz)||1;
const light=Math.abs(.35*nx+.45*ny+.82*nz)/l,k=.35+.65*light;
g.fillStyle=g.strokeStyle=`rgb(${153*k|0},${171*k|0},${194*k|0})`;g.beginPath();
g.moveTo(w/2+s*X[a],h/2-s*Y[a]);g.lineTo(w/2+s*X[b],h/2-s*Y[b]);g.lineTo(w/2+s*X[d],h/2-s*Y[d]);g.closePath();g.fill();g.stroke();}}
c.onpointermove=e=>{if(e.buttons){az-=e.movementX/150;el=Math.max(-1.57,Math.min(1.57,el+e.movementY/150));draw();}};
c.onwheel=e=>{e.preventDefault();zoom*=Math.exp(-e.deltaY/500);draw();};addEventListener("resize",draw);draw();
</script>"""

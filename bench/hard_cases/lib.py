import numpy as np, os, json, subprocess, math, hashlib, csv, shutil, itertools
G=9.81
BIN=os.environ.get('JBIN','build/src/tool/bin_scenes')
# ---------- meshes: (V,F) with outward triangles
def fix(V,F):
    V=np.array(V,float); F=[list(f) for f in F]
    vol=sum(np.dot(V[a],np.cross(V[b],V[c])) for a,b,c in F)/6
    if vol<0: F=[[a,c,b] for a,b,c in F]
    return V,F
def hull_prism(poly,z0,z1):
    """convex polygon (ccw) extruded along z"""
    n=len(poly); V=[[x,y,z0] for x,y in poly]+[[x,y,z1] for x,y in poly]; F=[]
    for i in range(n):
        j=(i+1)%n; F+=[[i,j,n+j],[i,n+j,n+i]]
    for i in range(1,n-1): F+=[[0,i+1,i],[n,n+i,n+i+1]]
    return fix(V,F)
def box(x,y,z): return hull_prism([(-x/2,-y/2),(x/2,-y/2),(x/2,y/2),(-x/2,y/2)],-z/2,z/2)
def ngon(n,r,ph=0): return [(r*math.cos(2*math.pi*i/n+ph),r*math.sin(2*math.pi*i/n+ph)) for i in range(n)]
def prism(n,r,h,ph=0): return hull_prism(ngon(n,r,ph),-h/2,h/2)
def spike(n,r,h,ph=None):
    """base at z=0, tip at z=h"""
    ph=math.pi/n if ph is None else ph
    b=ngon(n,r,ph); V=[[x,y,0] for x,y in b]+[[0,0,h]]
    F=[[i,(i+1)%n,n] for i in range(n)]+[[0,i+1,i] for i in range(1,n-1)]
    return fix(V,F)
def rot(m,R): return np.array(m[0])@np.array(R).T,m[1]
def move(m,t): return np.array(m[0])+np.array(t),m[1]
def Rx(a): c,s=math.cos(a),math.sin(a); return np.array([[1,0,0],[0,c,-s],[0,s,c]])
def Ry(a): c,s=math.cos(a),math.sin(a); return np.array([[c,0,s],[0,1,0],[-s,0,c]])
def Rz(a): c,s=math.cos(a),math.sin(a); return np.array([[c,-s,0],[s,c,0],[0,0,1]])
def join(*ms):
    V=[];F=[];o=0
    for v,f in ms:
        V+=list(map(list,v)); F+=[[a+o for a in t] for t in f]; o+=len(v)
    return np.array(V),F
def ring(n,outer,inner,h,no=None):
    """outer, inner: lists of n points; extruded"""
    V=[[x,y,-h/2] for x,y in outer]+[[x,y,h/2] for x,y in outer]+[[x,y,-h/2] for x,y in inner]+[[x,y,h/2] for x,y in inner]; F=[]
    n=len(outer)
    for i in range(n):
        j=(i+1)%n
        F+=[[i,j,n+j],[i,n+j,n+i]]
        F+=[[2*n+i,3*n+j,2*n+j],[2*n+i,3*n+i,3*n+j]]
        F+=[[n+i,n+j,3*n+j],[n+i,3*n+j,3*n+i]]
        F+=[[i,2*n+j,j],[i,2*n+i,2*n+j]]
    return fix(V,F)
def square_pts(n,a):
    """n points on a square of half edge a by angle, corners hit when n%8==0"""
    out=[]
    for i in range(n):
        t=2*math.pi*i/n; c,s=math.cos(t),math.sin(t); k=a/max(abs(c),abs(s)); out.append((c*k,s*k))
    return out
def torus(R,r,n=32,m=12,stretch=0):
    V=[];F=[]
    for i in range(n):
        a=2*math.pi*i/n; dx=stretch/2*(1 if math.cos(a)>1e-9 else -1 if math.cos(a)<-1e-9 else 0)
        for j in range(m):
            b=2*math.pi*j/m; q=R+r*math.cos(b); V.append([q*math.cos(a)+dx,q*math.sin(a),r*math.sin(b)])
    for i in range(n):
        for j in range(m):
            a,b,c,d=i*m+j,((i+1)%n)*m+j,((i+1)%n)*m+(j+1)%m,i*m+(j+1)%m
            F+=[[a,b,c],[a,c,d]]
    return fix(V,F)
def slab(nx,ny,cell,thick,seed=0):
    """tessellated plate, top at z=0, its centre at the origin; nodes of the top jittered in plane"""
    rng=np.random.default_rng(seed); V=[];F=[]
    for k,z in ((0,0.0),(1,-thick)):
        for i in range(nx+1):
            for j in range(ny+1):
                x=(i-nx/2)*cell; y=(j-ny/2)*cell
                if k==0 and 0<i<nx and 0<j<ny: x+=rng.uniform(-.3,.3)*cell; y+=rng.uniform(-.3,.3)*cell
                V.append([x,y,z])
    N=(nx+1)*(ny+1); id=lambda k,i,j:k*N+i*(ny+1)+j
    for i in range(nx):
        for j in range(ny):
            a,b,c,d=id(0,i,j),id(0,i+1,j),id(0,i+1,j+1),id(0,i,j+1)
            F+=[[a,b,c],[a,c,d]] if (i+j)%2 else [[a,b,d],[b,c,d]]
            a,b,c,d=id(1,i,j),id(1,i+1,j),id(1,i+1,j+1),id(1,i,j+1)
            F+=[[a,c,b],[a,d,c]]
    for i in range(nx):
        for j in (0,ny):
            a,b,c,d=id(0,i,j),id(0,i+1,j),id(1,i+1,j),id(1,i,j)
            F+=[[a,c,b],[a,d,c]] if j==0 else [[a,b,c],[a,c,d]]
    for j in range(ny):
        for i in (0,nx):
            a,b,c,d=id(0,i,j),id(0,i,j+1),id(1,i,j+1),id(1,i,j)
            F+=[[a,b,c],[a,c,d]] if i==0 else [[a,c,b],[a,d,c]]
    return fix(V,F)
def thread(r0,r1,pitch,turns,seg=24,inside=None):
    """rod (inside None) of core radius r0, crest r1, triangular thread; or a nut: outer prism radius `inside`, hole with that thread"""
    per=8; nz=int(turns*per); V=[];F=[]
    L=turns*pitch
    def rad(a,z):
        u=((z/pitch-a/(2*math.pi))%1.0); t=1-abs(2*u-1)   # 0..1
        return r0+(r1-r0)*t
    for k in range(nz+1):
        z=-L/2+L*k/nz
        for i in range(seg):
            a=2*math.pi*i/seg; q=rad(a,z); V.append([q*math.cos(a),q*math.sin(a),z])
    id=lambda k,i:k*seg+i%seg
    for k in range(nz):
        for i in range(seg):
            a,b,c,d=id(k,i),id(k,i+1),id(k+1,i+1),id(k+1,i)
            F+=[[a,b,c],[a,c,d]] if inside is None else [[a,c,b],[a,d,c]]
    n=len(V)
    if inside is None:
        V+=[[0,0,-L/2],[0,0,L/2]]
        for i in range(seg): F+=[[n,id(0,i+1),id(0,i)],[n+1,id(nz,i),id(nz,i+1)]]
    else:
        for z in(-L/2,L/2):
            for i in range(seg):
                a=2*math.pi*i/seg; V.append([inside*math.cos(a),inside*math.sin(a),z])
        lo=lambda i:n+i%seg
        hi=lambda i:n+seg+i%seg
        for i in range(seg):
            F+=[[lo(i),lo(i+1),hi(i+1)],[lo(i),hi(i+1),hi(i)]]
            F+=[[id(0,i),id(0,i+1),lo(i+1)],[id(0,i),lo(i+1),lo(i)]]
            F+=[[id(nz,i),hi(i+1),id(nz,i+1)],[id(nz,i),hi(i),hi(i+1)]]
    return fix(V,F)
def massprops(m):
    V,F=np.array(m[0]),np.array(m[1]); a,b,c=V[F[:,0]],V[F[:,1]],V[F[:,2]]
    d=np.einsum('ij,ij->i',a,np.cross(b,c))/6; vol=d.sum(); com=((a+b+c)/4*d[:,None]).sum(0)/vol
    a,b,c=a-com,b-com,c-com; s=a+b+c
    C=(np.einsum('i,ij,ik->jk',d,a,a)+np.einsum('i,ij,ik->jk',d,b,b)+np.einsum('i,ij,ik->jk',d,c,c)+np.einsum('i,ij,ik->jk',d,s,s))/20
    I=(np.trace(C)*np.eye(3)-C)/vol
    diag=np.linalg.norm(V.max(0)-V.min(0))
    return vol,com,I,diag
def q_of(R):
    R=np.array(R); t=np.trace(R)
    if t>0:
        w=math.sqrt(1+t)/2; return [(R[2,1]-R[1,2])/(4*w),(R[0,2]-R[2,0])/(4*w),(R[1,0]-R[0,1])/(4*w),w]
    i=int(np.argmax(np.diag(R))); j,k=(i+1)%3,(i+2)%3
    x=math.sqrt(max(0,1+R[i,i]-R[j,j]-R[k,k]))/2; q=[0,0,0,0]; q[i]=x; q[j]=(R[j,i]+R[i,j])/(4*x); q[k]=(R[k,i]+R[i,k])/(4*x); q[3]=(R[k,j]-R[j,k])/(4*x); return q
def R_of(q):
    x,y,z,w=q
    return np.array([[1-2*(y*y+z*z),2*(x*y-z*w),2*(x*z+y*w)],[2*(x*y+z*w),1-2*(x*x+z*z),2*(y*z-x*w)],[2*(x*z-y*w),2*(y*z+x*w),1-2*(x*x+y*y)]])
class P:
    def __init__(s,mesh,pos=(0,0,0),R=np.eye(3),mu=0.5,e=0.0,rho=1000.0,fixed=False,v=(0,0,0),w=(0,0,0),mass=None,motion=None):
        s.mesh,s.pos,s.R,s.mu,s.e,s.rho,s.fixed,s.v,s.w,s.motion=mesh,np.array(pos,float),np.array(R,float),mu,e,rho,fixed,v,w,motion
        s.vol,s.com,s.I,s.diag=massprops(mesh); s.mass=mass or rho*s.vol
class Case:
    def __init__(s,parts,seconds,checks=(),floor=True,mu=0.5,e=0.0,gravity=None,rate=None,pen=0.01,gain=0.01,extra=None):
        s.parts=sorted(parts,key=lambda p:p.fixed); s.order=[s.parts.index(p) for p in parts]
        s.seconds,s.checks,s.floor,s.mu,s.e,s.gravity,s.rate,s.pen,s.gain,s.extra=seconds,list(checks),floor,mu,e,gravity,rate,pen,gain,extra or {}
class Run: pass
def write(case,folder,step=None,solver='sphere'):
    shutil.rmtree(folder,ignore_errors=True); os.makedirs(folder)
    lines=['seed: 1','bin: {floor: true, friction: %.9g, restitution: %.9g}'%(case.mu,case.e) if case.floor else 'bin: {none: true}',
           'gravity: [%.9g, %.9g, %.9g]'%tuple(case.gravity if case.gravity is not None else (0,0,-G)),
           'pour: {pattern: given}','memory_budget: 3000000000','parts:']
    groups=[]
    for p in case.parts:
        V,F=p.mesh; t=''.join('v %.12g %.12g %.12g\n'%tuple(v) for v in V)+''.join('f %d %d %d\n'%tuple(i+1 for i in f) for f in F)
        h=hashlib.md5(t.encode()).hexdigest()[:10]; fn=folder+'/m_'+h+'.obj'
        if not os.path.exists(fn): open(fn,'w').write(t)
        key=(h,'%.12g'%p.mass,p.mu,p.e,p.fixed,str(p.motion))
        if groups and groups[-1][0]==key: groups[-1][1].append(p)
        else: groups.append((key,[p]))
    f=lambda a:'['+', '.join('%.12g'%x for x in a)+']'
    for key,ps in groups:
        p=ps[0]
        l='  - {model: m_%s.obj, unit: m, mass: %s, friction: %.9g, restitution: %.9g, count: %d, poses: [%s]'%(key[0],key[1],p.mu,p.e,len(ps),', '.join(f(list(q.pos)+q_of(q.R)) for q in ps))
        if p.fixed: l=l.replace('mass: %s, '%key[1],'')+', fixed: true'
        else: l+=', velocities: [%s]'%', '.join(f(list(q.v)+list(q.w)) for q in ps)
        if p.motion: l+=', motion: '+p.motion
        lines.append(l+'}')
    open(folder+'/r.yaml','w').write('\n'.join(lines)+'\n')
def run(case,folder,step=None,solver='sphere',preset=None,timeout=120):
    write(case,folder)
    cmd=[BIN,'generate',folder+'/r.yaml','--out',folder+'/o','--formats','json','--seconds','%.9g'%case.seconds,'--solver',solver,'--trace',folder+'/t.csv','--trace-rate','%g'%(case.rate or 400)]
    if step and solver=='sphere': cmd+=['--set','solver.sphere.time_step=%g'%step]
    for k,v in case.extra.items(): cmd+=['--set','%s=%s'%(k,v)]
    env=dict(os.environ,LP_NUM_THREADS='0',BIN_SCENES_PROGRESS='0',BIN_SCENES_ASSERTIONS='1')
    r=Run(); r.error=None
    import resource
    u0=resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    try: o=subprocess.run(cmd,capture_output=True,text=True,env=env,timeout=timeout)
    except subprocess.TimeoutExpired: r.error='TIMEOUT'; return r
    r.cpu=resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime-u0
    sj=folder+'/o/scene_000000/scene.json'
    if not os.path.exists(sj): sj=folder+'/o/set_apart/scene_000000/scene.json'
    if not os.path.exists(sj): r.error='NO SCENE: '+(o.stderr or o.stdout)[-300:]; return r
    r.scene=json.load(open(sj)); r.rep=r.scene['report']; r.note=o.stderr[-200:]
    d=np.genfromtxt(folder+'/t.csv',delimiter=',',skip_header=1); d=np.atleast_2d(d)
    ids=sorted(set(d[:,1].astype(int))); r.ids=ids
    r.tr=[d[d[:,1]==i] for i in ids]      # rows: time,id,pos3,q4,v3,w3
    n=min(len(t) for t in r.tr); r.tr=np.array([t[:n] for t in r.tr]); r.t=r.tr[0,:,0]
    free=[p for p in case.parts if not p.fixed]; r.free=free
    E=np.zeros(n); g=np.array(case.gravity if case.gravity is not None else (0,0,-G))
    md=0; r.com=[];r.Pm=np.zeros((n,3));r.L=np.zeros((n,3)); r.E1=[]
    for k,p in enumerate(free):
        a=r.tr[k]; c=np.zeros((n,3)); K=np.zeros(n)
        for i in range(n):
            R=R_of(a[i,5:9]); c[i]=a[i,2:5]+R@p.com; w=R.T@a[i,12:15]
            K[i]=.5*p.mass*(a[i,9:12]@a[i,9:12])+.5*p.mass*w@p.I@w; r.L[i]+=p.mass*(R@(p.I@w)+np.cross(c[i],a[i,9:12]))
        r.Pm+=p.mass*a[:,9:12]; E1=K-p.mass*(c@g); E+=E1; r.E1.append(E1)
        r.com.append(c)
        md+=p.mass*p.diag*(np.linalg.norm(g) or G)
    r.E=E; r.md=md; low=np.minimum.accumulate(E); r.gain=float((E-low).max()/md)
    r.gainT=float(r.t[int((E-low).argmax())])
    return r
def angle(R1,R2): return math.acos(max(-1,min(1,(np.trace(R1.T@R2)-1)/2)))
def up(r,k,i=-1,axis=2): return R_of(r.tr[k][i,5:9])[:,axis]
def moved(r,k): return float(np.linalg.norm(r.com[k][-1]-r.com[k][0])/r.free[k].diag)
def movedmax(r,k): return float(np.linalg.norm(r.com[k]-r.com[k][0],axis=1).max()/r.free[k].diag)
def turned(r,k,i=-1): return angle(R_of(r.tr[k][0,5:9]),R_of(r.tr[k][i,5:9]))
def judge(case,r):
    """list of failures, accepted"""
    if r.error: return [r.error],False,['error']
    bad=[]
    if not np.isfinite(r.tr).all(): bad.append('not finite')
    w=r.rep['worst']; pr=w['penetration']['relative']
    if case.gain is not None and r.gain>case.gain: bad.append('energy +%.2f %% of m g d at %.3f s (report %.2f %%)'%(100*r.gain,r.gainT,100*w['energy_gain']['relative']))
    if case.pen is not None and pr>case.pen: bad.append('penetration on the way %.2f %% d at %.3f s'%(100*pr,w['penetration']['time']))
    fin=max(r.rep['penetration']['max_relative'],0)
    if fin>0.01: bad.append('penetration at the end %.2f %%'%(100*fin))
    for c in case.checks:
        m=c(r)
        if m: bad.append(m)
    return bad,r.rep['accepted'],r.rep['reasons']

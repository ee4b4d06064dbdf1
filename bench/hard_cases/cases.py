from lib import *
C={}
def case(name,**kw):
    def deco(f):
        C[name]=(f,kw); return f
    return deco
def add(name,f,**kw): C[name]=(f,kw)
def T(s): return math.sqrt(s/G)
BIG=lambda s:box(6*s,6*s,s)
def plate(s,mu=.5,z=0,**k): return P(BIG(s),(0,0,z-s/2),mu=mu,fixed=True,**k)
def stays(k=0,tol=.01,ang=.02):
    def f(r):
        for i in ([k] if isinstance(k,int) else k):
            a,b=movedmax(r,i),max(turned(r,i,j) for j in range(0,len(r.t),max(1,len(r.t)//50)))
            if a>tol or b>ang: return 'part %d does not stay: %.2f %% d, %.2f deg'%(i,100*a,math.degrees(b))
    return f
def falls(k=0,tol=.3):
    def f(r):
        if movedmax(r,k)<tol: return 'part %d does not fall (%.2f %% d)'%(k,100*movedmax(r,k))
    return f
def height(k,z,s,tol=.01):
    def f(r):
        if abs(r.com[k][-1][2]-z)>tol*s: return 'height of %d: %.4f instead of %.4f edges'%(k,r.com[k][-1][2]/s,z/s)
    return f
def above(z=0,tol=.01):
    def f(r):
        for i,p in enumerate(r.free):
            V=np.array(p.mesh[0]); a=r.tr[i]
            for j in range(0,len(a),max(1,len(a)//60)):
                m=(V@R_of(a[j,5:9]).T+a[j,2:5])[:,2].min()
                if m<z-tol*p.diag: return 'part %d is %.2f %% d below the floor at %.2f s'%(i,100*(z-m)/p.diag,a[j,0])
    return f
# ---- spikes
for n in (3,4,6,24):
    def tip(s,n=n):
        a=spike(n,s/2,s)
        return Case([P(a,(0,0,s*2.02),Rx(math.pi)),P(a,(0,0,0))],6*T(s),[above()],gain=.001)
    add('tip_on_tip_%d'%n,tip,steps=1)
    def tipf(s,n=n):
        a=spike(n,s/2,s)
        return Case([P(a,(0,0,s*1.2),Rx(math.pi+.05)),plate(s)],12*T(s),[above()],rate=200)
    add('tip_on_face_%d'%n,tipf,steps=1)
    def tipoff(s,n=n):
        a=spike(n,s/2,s)
        return Case([P(a,(.02*s,.013*s,s*2.1),Rx(math.pi)),P(a,fixed=True)],6*T(s),[],gain=.01)
    add('tip_beside_tip_%d'%n,tipoff,steps=1)
def wedge(w,h,l): # ridge along y at z=h
    return rot(hull_prism([(-w/2,0),(w/2,0),(0,h)],-l/2,l/2),Rx(math.pi/2))
def wedge_ok(w,h,l):
    m=wedge(w,h,l); return m
@case('spike_on_wedge',steps=1)
def _(s):
    return Case([P(spike(4,s/2,s),(.03*s,.1*s,s*2.05),Rx(math.pi)),P(wedge(s,s,2*s),fixed=True)],6*T(s))
@case('wedge_on_wedge_crossed',steps=1)
def _(s):
    return Case([P(wedge(s,s,2*s),(0,0,s*2.02),Rz(math.pi/2)@Rx(math.pi)),P(wedge(s,s,2*s),fixed=True)],6*T(s))
@case('wedge_on_wedge_parallel',steps=1)
def _(s):
    return Case([P(wedge(s,s,2*s),(0.01*s,0,s*2.02),Rx(math.pi)),P(wedge(s,s,2*s),fixed=True)],6*T(s))
for n in (4,24):
    def hole(s,n=n):
        N=32; a=spike(n,s/2,2*s); h=.3*s
        inner=square_pts(N,h/math.sqrt(2)) if n==4 else ngon(24,h)
        out=square_pts(N,1.5*s) if n==4 else square_pts(24,1.5*s)
        # tip down; a round/square hole of circumradius h: the spike's circumradius at depth t below base...
        ph=math.pi/4 if n==4 else 0
        a=spike(n,s/2,2*s,ph=ph)
        zt=-h/(s/2)*2*s    # tip's height below the top
        m=ring(N,out,inner,4*s); 
        return Case([P(a,(0,0,zt+2*s+.05*s),Rx(math.pi)),P(m,(0,0,-2*s),fixed=True)],10*T(s),[lambda r:('rests %.2f %% d from its place'%(100*abs(r.com[0][-1][2]-(zt+2*s-.5*s))/r.free[0].diag) if abs(r.com[0][-1][2]-(zt+2*s-.5*s))>.01*r.free[0].diag else None),lambda r:'leans %.2f deg'%math.degrees(math.acos(-up(r,0)[2])) if -up(r,0)[2]<math.cos(.02) else None],floor=False)
    add('spike_in_hole_%d'%n,hole,steps=1)
@case('spike_in_crack',steps=1)
def _(s):
    w=.4*s; a=spike(4,s/2*math.sqrt(2),2*s,ph=math.pi/4); zt=-(w/2)/(s/2)*2*s
    b=box(2*s,4*s,3*s)
    return Case([P(a,(0,0,zt+2.05*s),Rx(math.pi)),P(b,(w/2+s,0,-1.5*s),fixed=True),P(b,(-w/2-s,0,-1.5*s),fixed=True)],10*T(s),[lambda r:('rests %.2f %% d from its place'%(100*abs(r.com[0][-1][2]-(zt+1.5*s))/r.free[0].diag) if abs(r.com[0][-1][2]-(zt+1.5*s))>.01*r.free[0].diag else None)],floor=False)
@case('wedge_in_crack',steps=1)
def _(s):
    w=.4*s; zt=-(w/2)/(s/2)*2*s; b=box(2*s,4*s,3*s)
    return Case([P(wedge(s,2*s,s),(0,0,zt+2.03*s),Rx(math.pi)),P(b,(w/2+s,0,-1.5*s),fixed=True),P(b,(-w/2-s,0,-1.5*s),fixed=True)],10*T(s),[lambda r:('rests %.2f %% d from its place'%(100*abs(r.com[0][-1][2]-(zt+4/3*s))/r.free[0].diag) if abs(r.com[0][-1][2]-(zt+4/3*s))>.01*r.free[0].diag else None)],floor=False)
@case('wedge_splits_cubes')
def _(s):
    c=box(s,s,s)
    def sym(r):
        a=np.abs(r.com[1]+r.com[2])[:,0].max()/s
        if a>.002: return 'cubes apart unsymmetrically by %.3f %% of an edge'%(100*a)
        if r.com[1][-1][0]<.52*s: return 'cubes do not part'
    return Case([P(wedge(.8*s,s,.8*s),(0,0,2.1*s),Rx(math.pi),mu=.01,mass=4),P(c,(.501*s,0,s/2),mu=.01,mass=1),P(c,(-.501*s,0,s/2),mu=.01,mass=1)],3*T(s),[sym,above()],mu=.01)
# ---- cliffs
for name,off,st in (('inside',-.1,1),('outside',.1,0),('just_inside',-.02,1)):
    def cl(s,off=off,st=st):
        return Case([P(box(s,s,s),(off*s,0,s*.5)),P(box(4*s,4*s,s),(-2*s,0,-s/2),fixed=True)],8*T(s),[stays(0) if st else falls(0)],floor=False)
    add('cliff_cube_'+name,cl)
def cliffcorner(s): return Case([P(box(s,s,s),(-.1*s,-.1*s,s*.5),Rz(math.pi/4)),P(box(4*s,4*s,s),(-2*s,-2*s,-s/2),fixed=True)],8*T(s),[stays(0)],floor=False)
add('cliff_corner_cube_rests',cliffcorner)
# ---- sliding on planes
def slide_check(s,v,mu,tol=.01):
    d=v*v/(2*mu*G)
    def f(r):
        p=r.com[0][-1]-r.com[0][0]
        if abs(p[0]-d)>tol*d: return 'slid %.4f instead of %.4f'%(p[0]/d,1)
        if abs(p[1])>.01*d: return 'went aside %.2f %%'%(100*abs(p[1])/d)
        if np.abs(r.com[0][:,2]-r.com[0][0][2]).max()>.01*s: return 'left the plane by %.2f %% of an edge'%(100*np.abs(r.com[0][:,2]-r.com[0][0][2]).max()/s)
    return f
def slid(s,kind,mu=.2,n=12):
    v=math.sqrt(2*mu*G*3*s)
    if kind=='tess': fl=[P(slab(24,12,.4*s,s),(2*s,0,0),mu=mu,fixed=True)]
    if kind=='plate': fl=[P(box(12*s,6*s,s),(2*s,0,-s/2),mu=mu,fixed=True)]
    if kind=='tiles': b=box(.999999*s,6*s,s); fl=[P(b,((i-2)*s,0,-s/2),mu=mu,fixed=True) for i in range(9)]
    if kind=='floor': fl=[]
    return Case([P(box(s,s,.5*s),(0,0,.25*s),Rz(.3),mu=mu,v=(v,0,0))]+fl,v/(mu*G)+3*T(s),[slide_check(s,v,mu)],floor=not fl,mu=mu)
for k in('tess','plate','tiles','floor'): add('slides_'+k,lambda s,k=k:slid(s,k))
def glide(s,kind):
    v=3*math.sqrt(G*s)
    fl=[P(slab(40,12,.4*s,s),(5*s,0,0),mu=0,fixed=True)] if kind=='tess' else [P(box(.999999*s,6*s,s),((i-2)*s,0,-s/2),mu=0,fixed=True) for i in range(14)]
    def f(r):
        e=np.abs(r.tr[0][:,9:12]-r.tr[0][0,9:12]).max()/v
        if e>.002: return 'speed changes by %.3f %%'%(100*e)
    return Case([P(box(s,s,.5*s),(0,0,.25*s),Rz(.3),mu=0,v=(v,0,0))]+fl,8*s/v,[f],floor=False)
for k in('tess','tiles'): add('glides_'+k,lambda s,k=k:glide(s,k))
add('rests_on_tess',lambda s:Case([P(box(s,s,s),(0.1*s,.07*s,s/2),Rz(.2)),P(slab(12,12,.4*s,s),fixed=True)],10*T(s),[stays(0,.002,.002)],floor=False))
@case('skims_over_tess_at_speed')
def _(s):
    v=20*math.sqrt(G*s)
    def f(r):
        if r.com[0][:,2].max()-.25*s>.01*s: return 'thrown up by %.2f %% of an edge'%(100*(r.com[0][:,2].max()-.25*s)/s)
    return Case([P(box(s,s,.5*s),(-6*s,0,.25*s),mu=.05,v=(v,0,0)),P(slab(50,10,.4*s,s),fixed=True,mu=.05)],12*s/v,[f],floor=False)
# ---- inclines
for nm,k in(('holds',.9),('slips',1.2)):
    def inc(s,k=k):
        mu=.4; a=math.atan(k*mu); R=Ry(-a); n=R@np.array([0,0,1.]); 
        chk=stays(0,.003) if k<1 else (lambda r:(lambda d,x:'slid %.3f instead of 1'%(d/x) if abs(d/x-1)>.02 else None)(np.linalg.norm(r.com[0][-1]-r.com[0][0]),.5*G*(math.sin(a)-mu*math.cos(a))*r.t[-1]**2))
        return Case([P(box(s,s,.5*s),n*.25*s,R,mu=mu),P(box(12*s,6*s,s),-n*s/2,R,mu=mu,fixed=True)],6*T(s),[chk],floor=False)
    add('incline_'+nm,inc)
for nm,k in(('stands',.9),('topples',1.1)):
    def inc(s,k=k):
        h=2*s; a=math.atan(k*s/h); R=Ry(-a); n=R@np.array([0,0,1.])
        return Case([P(box(s,s,h),n*h/2,R,mu=1.),P(box(12*s,6*s,s),-n*s/2,R,mu=1.,fixed=True)],8*T(s),[stays(0,.003) if k<1 else falls(0,.3)],floor=False)
    add('block_on_incline_'+nm,inc)
# ---- unequal masses
for ratio in(10,100,300,1000):
    for mu in(.5,0.):
        def un(s,ratio=ratio,mu=mu):
            c=box(s,s,s); m=1000*s**3
            return Case([P(c,(0,0,s/2),mu=mu,mass=m),P(c,(0.02*s,.01*s,1.5*s),mu=mu,mass=ratio*m)],10*T(s),[stays([0,1])],mu=mu)
        add('heavy_on_light_%d_mu%g'%(ratio,mu),un,steps=1)
    def li(s,ratio=ratio):
        c=box(s,s,s); m=1000*s**3
        return Case([P(c,(0,0,s/2),mass=ratio*m),P(c,(0.02*s,.01*s,1.5*s),mass=m)],8*T(s),[stays([0,1])])
    add('light_on_heavy_%d'%ratio,li)
    def drop(s,ratio=ratio):
        c=box(s,s,s); m=1000*s**3
        def f(r):
            if r.com[1][-1][2]<1.45*s and abs(r.com[1][-1][0])<.5*s : return 'heavy one at %.3f edges'%(r.com[1][-1][2]/s)
        return Case([P(c,(0,0,s/2),mass=m),P(c,(0,0,2*s),mass=ratio*m)],8*T(s),[above(),stays(0,.02),height(1,1.5*s,s)])
    add('heavy_falls_on_light_%d'%ratio,drop,steps=1)
    def sy(s,ratio=ratio):
        c=box(s,s,s); m=1000*s**3; v=math.sqrt(G*s)*4
        def f(r):
            a=np.abs(r.tr[0][:,9:12]).max()/v; b=np.abs(r.tr[:,:,10:12]).max()/v
            if max(a,b)>1e-4: return 'unsymmetric by %.4f %% of the speed'%(100*max(a,b))
        return Case([P(c,mass=m),P(c,(1.2*s,0,0),mass=ratio*m,v=(-v,0,0)),P(c,(-1.2*s,0,0),mass=ratio*m,v=(v,0,0))],4*T(s),[f],floor=False,gravity=(0,0,0))
    add('symmetric_impact_%d'%ratio,sy,steps=1)
for e in(0.,.5,1.):
    def im(s,e=e):
        c=box(s,s,s); m=1000*s**3; v=math.sqrt(G*s)*4; M=3*m
        v1=(m-e*M)/(m+M)*v; v2=(1+e)*m/(m+M)*v
        def f(r):
            d=np.abs(np.array([r.tr[0][-1,9]-v1,r.tr[1][-1,9]-v2])).max()/v; o=np.abs(r.tr[:,-1,10:15]*[1,1,s,s,s]).max()/v
            if d>.003: return 'speeds off by %.2f %%'%(100*d)
            if o>1e-3: return 'aside or turning by %.3f %%'%(100*o)
            p=np.abs(r.Pm-r.Pm[0]).max()/(m*v)
            if p>1e-4: return 'momentum off by %.3f %%'%(100*p)
        return Case([P(c,mass=m,v=(v,0,0),e=e),P(c,(1.5*s,.2*s,.1*s)if 0 else(1.5*s,0,0),mass=M,e=e)],3*T(s),[f],floor=False,gravity=(0,0,0))
    add('impact_e%g'%e,im)
# ---- card houses
for lev in(1,2,3,4,5):
    def house(s,lev=lev):
        L,W,t,lean=s,s*2/3,s/90,.42; up_=.5*(L*math.cos(lean)+t*math.sin(lean)); out=.5*(L*math.sin(lean)+t*math.cos(lean)); pitch=4*out; lh=2*up_+t
        card,roof=box(t,W,L),box(.98*pitch,W,t); ps=[]
        for l in range(lev):
            pairs=lev-l; first=-.5*(pairs-1)*pitch
            for i in range(pairs):
                for sd in(-1,1): ps.append(P(card,(first+i*pitch+sd*out,0,l*lh+up_),Ry(-sd*lean)))
            for i in range(pairs-1): ps.append(P(roof,(first+(i+.5)*pitch,0,l*lh+2*up_+t/2)))
        return Case(ps,16*T(s),[stays(list(range(len(ps))),.03,.05)],rate=100)
    add('card_house_%d'%lev,house,slow=lev>3)
# ---- arches
for n,tr,st in((7,.25,1),(15,.25,1),(25,.25,1),(15,.06,0)):
    def arch(s,n=n,tr=tr,st=st):
        R=3*s; t=tr*R; ps=[]; a=math.pi/n
        ri,ro=R-t/2,R+t/2
        q=[(ri*math.sin(-a/2),ri*math.cos(a/2)),(ri*math.sin(a/2),ri*math.cos(a/2)),(ro*math.sin(a/2),ro*math.cos(a/2)),(ro*math.sin(-a/2),ro*math.cos(a/2))]
        cy=np.mean([p[1] for p in q]); m=rot(hull_prism([(x,y-cy) for x,y in q],-s/2,s/2),Rx(math.pi/2))
        for i in range(n):
            th=-math.pi/2+a*(i+.5); ps.append(P(m,(cy*math.sin(th),0,cy*math.cos(th)),Ry(th),mu=.7))
        return Case(ps,12*T(s),[stays(list(range(n)),.02,.03) if st else falls(n//2,.3)],mu=.7,rate=100)
    add('arch_%d%s'%(n,'' if st else '_thin'),arch)
# ---- rows and rocking
@case('dominoes')
def _(s):
    h,w,t,gap=s,s/2,s/8,.5*s
    ps=[P(box(t,w,h),(i*gap,0,h/2)) for i in range(8)]; ps[0]=P(box(t,w,h),(.1*s,0,h/2+.012*s),Ry(.28))
    ps[0]=P(box(t,w,h),(0,0,h/2*math.cos(.3)+t/2*math.sin(.3)),Ry(.3))
    def f(r):
        n=sum(abs(up(r,i)[2])<.8 for i in range(8))
        if n<8: return 'only %d of 8 fall'%n
    return Case(ps,20*T(s),[f,above()],rate=200)
@case('domino_alone_stands')
def _(s): return Case([P(box(s/8,s/2,s),(0,0,s/2))],20*T(s),[stays(0,.001,.001)],rate=100)
for f0 in(.3,.7):
    def rock(s,f0=f0):
        al=.25; R=s/2; b,h=2*R*math.sin(al),2*R*math.cos(al); th=f0*al; p=math.sqrt(3*G/(4*R)); tq=math.acosh(1/(1-f0))/p
        def f(r):
            ang=np.array([math.atan2(up(r,0,i)[0],up(r,0,i)[2]) for i in range(len(r.t))]); i=int(np.argmax(ang<=0)) if (ang<=0).any() else -1
            if i<0: return 'never upright'
            x=r.t[i-1]+(r.t[i]-r.t[i-1])*ang[i-1]/(ang[i-1]-ang[i])
            if abs(x/tq-1)>.04: return 'quarter period %.3f of Housner'%(x/tq)
            sw=-ang.min()
            if sw>th*1.01: return 'swings higher than before: %.3f'%(sw/th)
        # pivot: its right lower edge at 0
        c=Ry(th)@np.array([-b/2,0,h/2])
        return Case([P(box(b,4*b,h),c,Ry(th),mu=2.)],8*tq,[f],mu=2.)
    add('rocking_%g'%f0,rock)
@case('cradle')
def _(s):
    c=box(s,s,s); v=math.sqrt(G*s)
    def f(r):
        sp=r.tr[:,-1,9]/v
        if abs(sp[-1]-1)>.02 or np.abs(sp[:-1]).max()>.02: return 'speeds '+' '.join('%.3f'%x for x in sp)
    return Case([P(c,((1.05 if i else -.0)*i*s-(.5*s if i==0 else 0),0,0),e=1.,mu=0,v=(v,0,0) if i==0 else(0,0,0)) for i in range(5)],2.5*s/v,[f],floor=False,gravity=(0,0,0))
# ---- fits
for play in(1e-4,3e-4):
    for n in(24,64):
        def peg(s,play=play,n=n):
            r=s/2; m=ring(n,ngon(n,1.6*r),ngon(n,r+play/math.cos(math.pi/n)),2*s)
            tf=math.sqrt(2*1.5*s/G)
            def f(r_):
                z=r_.com[0][:,2]; i=np.argmax(z<-1.4*s) if (z<-1.4*s).any() else -1
                if i<0: return 'peg hangs at %.2f edges'%(z[-1]/s)
                if abs(r_.t[i]/math.sqrt(2*(1.4+.0)*s/G)-1)>.2: return 'peg needs %.2f of the fall'%(r_.t[i]/math.sqrt(2*1.4*s/G))
            return Case([P(prism(n,r,2*s),(0,0,0),mu=.1),P(m,(0,0,0),mu=.1,fixed=True)],1.3*tf,[f],floor=False)
        add('peg_%gmm_%d'%(play*1e3,n),peg)
@case('peg_tilted_0.3mm')
def _(s):
    n=32;r=s/2;play=max(3e-4,.01*s); m=ring(n,ngon(n,1.6*r),ngon(n,r+play/math.cos(math.pi/n)),2*s)
    a=.5*play/(s)
    def f(r_):
        if r_.com[0][-1][2]>-1.0*s: return 'peg hangs at %.2f edges'%(r_.com[0][-1][2]/s)
    return Case([P(prism(n,r,2*s),(0,0,.3*s),Ry(a),mu=.1),P(m,mu=.1,fixed=True)],5*T(s),[f],floor=False)
@case('ring_on_peg')
def _(s):
    n=32;r=s/2;play=max(3e-4,.02*s); m=ring(n,ngon(n,1.6*r),ngon(n,r+play/math.cos(math.pi/n)),.4*s)
    return Case([P(m,(0,0,3*s),Rz(.1),mu=.2),P(prism(n,r,3*s),(0,0,1.5*s),fixed=True,mu=.2)],8*T(s),[height(0,.2*s,s,.02),above()])
@case('square_peg')
def _(s):
    play=max(3e-4,.01*s); m=ring(32,square_pts(32,s),square_pts(32,s/2+play),2*s)
    def f(r_):
        if r_.com[0][-1][2]>-1.0*s: return 'peg hangs at %.2f edges'%(r_.com[0][-1][2]/s)
    return Case([P(box(s,s,2*s),mu=.1),P(m,mu=.1,fixed=True)],3*T(s),[f],floor=False)
@case('bolt_in_nut')
def _(s):
    p=.25*s; r0,r1=.4*s,.5*s; play=.02*s
    b=thread(r0,r1,p,8); n=thread(r0+play,r1+play,p,3,inside=.9*s)
    w=2*math.pi*2/ (3*T(s))  # turns
    def f(r):
        z=r.com[0][:,2]-r.com[0][0][2]; ang=np.unwrap([math.atan2(R_of(x[5:9])[1,0],R_of(x[5:9])[0,0]) for x in r.tr[0]])
        turns=(ang-ang[0])/(2*math.pi); 
        if abs(turns[-1])<.5: return 'does not turn: %.2f, z %.3f pitch'%(turns[-1],z[-1]/p)
        if abs(z[-1]-turns[-1]*p)>.25*p: return 'turned %.2f, sank %.2f pitches'%(turns[-1],-z[-1]/p)
    return Case([P(b,(0,0,0),mu=.02,w=(0,0,-w)),P(n,mu=.02,fixed=True)],3*T(s),[f],floor=False,gain=.01)
# ---- hanging things
@case('chain_hangs')
def _(s):
    l=torus(.35*s,.1*s,24,10,stretch=.4*s); ps=[]
    pitch=.7*s+.4*s-.2*s   # inner length of a link: links touch at wire
    z=0
    for i in range(4):
        R=Ry(math.pi/2) if i%2==0 else Rz(math.pi/2)@Ry(math.pi/2)
        # long axis x -> z
        ps.append(P(l,(0,0,-i*(pitch-.0*s)),R,fixed=i==0))
    def f(r):
        for k in range(3):
            if abs(r.com[k][:,2]+(k+1)*pitch).max()>.05*s: return 'link %d at %.3f instead of %.3f'%(k,r.com[k][-1][2]/s,-(k+1)*pitch/s)
    return Case(ps,10*T(s),[f],floor=False,rate=200)
@case('chain_swings')
def _(s):
    l=torus(.35*s,.1*s,24,10,stretch=.4*s); ps=[]; pitch=.9*s; a=.6
    for i in range(5):
        R=Rx(a)@(Ry(math.pi/2) if i%2==0 else Rz(math.pi/2)@Ry(math.pi/2)); d=Rx(a)@np.array([0,0,-i*pitch])
        ps.append(P(l,d,R if i else R,fixed=i==0,mu=.2))
    def f(r):
        for k in range(4):
            d=np.linalg.norm(r.com[k]-(r.com[k-1] if k else 0),axis=1)
            if d.max()>pitch+.1*s: return 'link %d leaves the chain (%.2f)'%(k,d.max()/pitch)
    return Case(ps,15*T(s),[f],floor=False,rate=200)
@case('rings_interlocked')
def _(s):
    t=torus(.4*s,.08*s,32,12)
    return Case([P(t,(0,0,0),Rx(math.pi/2),fixed=True),P(t,(0,0,-.64*s-.0*s),Rz(math.pi/2)@Rx(math.pi/2))],10*T(s),[stays(0,.02,.1)],floor=False,rate=200)
@case('ring_pendulum')
def _(s):
    n=96; Ri=.5*s; rp=.2*s; m=rot(ring(n,ngon(n,.7*s),ngon(n,Ri),.3*s),Rx(math.pi/2)); peg=rot(prism(n,rp,s),Rx(math.pi/2)); a=.3; l=Ri-rp
    tp=2*math.pi*math.sqrt(l/G)*(1+a*a/16)
    def f(r):
        x=r.com[0][:,0]; z=np.where((x[:-1]>0)&(x[1:]<=0))[0]
        if len(z)<2: return 'does not swing'
        per=(r.t[z[-1]]-r.t[z[0]])/(len(z)-1)
        if abs(per/tp-1)>.05: return 'period %.3f'%(per/tp)
    return Case([P(m,(l*math.sin(a),0,-l*math.cos(a)),mu=0),P(peg,mu=0,fixed=True)],4*tp,[f],floor=False)
@case('pendulum_on_pin')
def _(s):
    n=32; play=.02*s; r=.15*s
    hole=ngon(n,r+play); outer=[(x+(0),y) for x,y in ngon(n,.3*s)]
    outer=[(x,y if y>0 else y*5) for x,y in outer]; m=rot(ring(n,outer,hole,.4*s),Rx(math.pi/2))
    a=.8; pin=rot(prism(n,r,s),Rx(math.pi/2))
    def f(r_):
        d=np.linalg.norm(r_.tr[0][:,2:5],axis=1).max()
        if d>3*play: return 'leaves its pin (%.1f play)'%(d/play)
    return Case([P(m,(0,0,-play*.9),Ry(a),mu=.1),P(pin,mu=.1,fixed=True)],15*T(s),[f],floor=False)
@case('dovetail_lift')
def _(s):
    # part with a conical head between two fixed jaws that rise
    head=rot(hull_prism([(-.25*s,0),(.25*s,0),(.5*s,.6*s),(-.5*s,.6*s)],-s/2,s/2),Rx(math.pi/2))
    j=rot(hull_prism([(.27*s,0),(1.2*s,0),(1.2*s,.6*s),(.52*s,.6*s)],-s/2,s/2),Rx(math.pi/2))
    j2=rot(hull_prism([(-1.2*s,0),(-.27*s,0),(-.52*s,.6*s),(-1.2*s,.6*s)],-s/2,s/2),Rx(math.pi/2))
    t=6*T(s); mo='{times: [%.9g], poses: [[0,0,%.9g,0,0,0,1]]}'%(t,2*s)
    def f(r):
        if r.com[0][-1][2]-r.com[0][0][2]<1.9*s: return 'is not lifted: %.2f'%((r.com[0][-1][2]-r.com[0][0][2])/s)
    return Case([P(head,(0,0,0)),P(j,fixed=True,motion=mo),P(j2,fixed=True,motion=mo)],8*T(s),[f],gain=None)
@case('friction_lift')
def _(s):
    # block clamped by two heavy leaning plates? a wedge lewis: two half wedges in a dovetail pocket is left out; block carried by a rising fixed plate
    t=6*T(s); mo='{times: [%.9g], poses: [[%.9g,0,%.9g,0,0,0,1]]}'%(t,s,s)
    return Case([P(box(s,s,s),(0,0,.75*s)),P(box(3*s,3*s,.5*s),fixed=True,motion=mo)],8*T(s),[lambda r:'carried to %.3f, %.3f'%(r.com[0][-1][0]/s,r.com[0][-1][2]/s) if abs(r.com[0][-1][0]-s)>.02*s or abs(r.com[0][-1][2]-1.75*s)>.02*s else None],floor=False,gain=None)
# ---- stacks
for n in(5,10,20):
    def st(s,n=n): return Case([P(box(s,s,s),(0,0,(i+.5)*s)) for i in range(n)],8*T(s),[stays(list(range(n)),.01,.02)],rate=100)
    add('stack_%d'%n,st)
for nm,k in(('stands',.9),('topples',1.12)):
    def ov(s,k=k):
        n=4; L=4*s; x=[0]*n; 
        for i in range(1,n): x[n-i-1+1]=0
        pos=[0.]; 
        for i in range(n-1,0,-1): pos.append(0)
        off=[0]; tot=0; xs=[0]*n
        # top brick i=n-1 overhangs L/2, next L/4 ...
        for i in range(n-2,-1,-1): xs[i]=xs[i+1]-k*L/(2*(n-1-i))
        return Case([P(box(L,2*s,s),(xs[i]-xs[0],0,(i+.5)*s)) for i in range(n)],10*T(s),[stays(list(range(n)),.01,.02) if k<1 else falls(n-1,.2)])
    add('overhang_'+nm,ov)
# ---- thin and odd
@case('sheet_on_edge_stands')
def _(s): return Case([P(box(s,.02*s,s),(0,0,s/2))],10*T(s),[stays(0,.002,.01)],rate=100)
@case('sheet_tilted_falls')
def _(s): return Case([P(box(s,.02*s,s),(0,0,s/2+.01*s),Rx(.08))],10*T(s),[above(),lambda r:'lies not' if abs(up(r,0,-1,1)[2])<.99 else None])
@case('sheet_between_walls')
def _(s): return Case([P(box(s,.02*s,s),(0,0,.55*s)),P(box(3*s,s,2*s),(0,.5*s+.013*s,s),fixed=True),P(box(3*s,s,2*s),(0,-.5*s-.013*s,s),fixed=True)],8*T(s),[height(0,.5*s,s)])
@case('ladder_holds')
def _(s):
    a=math.radians(60); L=2*s; t=.05*s # tan 60=1.73 > 1/(2 mu)=1 with mu .5
    return Case([P(box(t,.3*s,L),(-.5*L*math.cos(a)-.5*t*math.sin(a),0,.5*L*math.sin(a)+.5*t*math.cos(a)),Ry(math.pi/2-a)),P(box(s,4*s,6*s),(.5*s,0,3*s),mu=0,fixed=True)],10*T(s),[stays(0,.01,.02)])
@case('ladder_slips')
def _(s):
    a=math.radians(40); L=2*s; t=.05*s # tan 40=.84 < 1
    return Case([P(box(t,.3*s,L),(-.5*L*math.cos(a)-.5*t*math.sin(a),0,.5*L*math.sin(a)+.5*t*math.cos(a)),Ry(math.pi/2-a)),P(box(s,4*s,6*s),(.5*s,0,3*s),mu=0,fixed=True)],10*T(s),[falls(0,.15),above()])
tet=lambda s:fix([[0,0,0],[s,0,0],[s/2,s*.866,0],[s/2,s*.2887,s*.8165]],[[0,1,2],[0,1,3],[1,2,3],[2,0,3]])
@case('tetrahedra_fall',steps=1)
def _(s):
    rng=np.random.default_rng(3); ps=[]
    for i in range(8):
        q=rng.normal(size=4); q/=np.linalg.norm(q); ps.append(P(tet(s),(.8*s*(i%2),.8*s*(i//2%2),s+1.3*s*i),R_of(q)))
    return Case(ps,25*T(s),[above()],rate=200,pen=.03)
@case('tetra_on_tip_of_tetra',steps=1)
def _(s):
    t=move(tet(s),(-s/2,-s*.2887,0)); return Case([P(t,(0,0,2*.8165*s*1.02),Rx(math.pi)),P(t)],6*T(s),[above()])
@case('needles_fall')
def _(s):
    rng=np.random.default_rng(4); ps=[]
    for i in range(6):
        q=rng.normal(size=4); q/=np.linalg.norm(q); ps.append(P(box(s,.03*s,.03*s),(0,0,.7*s+.7*s*i),R_of(q)))
    return Case(ps,20*T(s),[above()],rate=200,pen=.03)
@case('plates_fall')
def _(s):
    rng=np.random.default_rng(5); ps=[]
    for i in range(6):
        q=rng.normal(size=4); q/=np.linalg.norm(q); ps.append(P(box(s,s,.02*s),(0,0,.8*s+1.5*s*i),R_of(q)))
    return Case(ps,25*T(s),[above()],rate=200,pen=.03)
@case('needle_upright_on_tip',steps=1)
def _(s): return Case([P(spike(4,.03*s,s),(0,0,s+.005*s),Rx(math.pi+.02))],10*T(s),[above(),lambda r:'lies not' if abs(up(r,0)[2])>.2 else None])
# ---- gyros
@case('dzhanibekov')
def _(s):
    w=20/T(s)
    def f(r):
        if (abs(r.L-r.L[0]).max()/np.linalg.norm(r.L[0]))>.01: return 'angular momentum off by %.2f %%'%(100*abs(r.L-r.L[0]).max()/np.linalg.norm(r.L[0]))
        if abs(r.E/r.E[0]-1).max()>.01: return 'energy off by %.2f %%'%(100*abs(r.E/r.E[0]-1).max())
        u=np.array([R_of(a[5:9])[:,1]@np.array([0,1.,0]) for a in r.tr[0]])
        if u.min()>-.9: return 'does not turn over'
    return Case([P(box(s,.6*s,.2*s),w=(0.01*w,w,0))],12*T(s),[f],floor=False,gravity=(0,0,0),gain=None)
@case('free_top_precesses')
def _(s):
    m=prism(24,s/2,.2*s); w3=15/T(s); w1=3/T(s)
    _,_,I,_=massprops(m); Om=math.hypot(I[0,0]*w1,I[2,2]*w3)/I[0,0]
    def f(r):
        L=r.L[0]/np.linalg.norm(r.L[0]); e1=np.cross(L,[0,1,0.]); e1/=np.linalg.norm(e1); e2=np.cross(L,e1)
        a=np.unwrap([math.atan2(R_of(x[5:9])[:,2]@e2,R_of(x[5:9])[:,2]@e1) for x in r.tr[0]])
        om=(a[-1]-a[0])/(r.t[-1]-r.t[0])
        if abs(om/Om-1)>.01: return 'precession %.4f'%(om/Om)
    return Case([P(m,w=(w1,0,w3))],6*T(s),[f],floor=False,gravity=(0,0,0),gain=None)
@case('spinning_top',steps=1)
def _(s):
    m=rot(spike(24,.5*s,.6*s),Rx(math.pi)); m=move(m,(0,0,.6*s)); w=40/T(s); a=.2
    def f(r):
        t=[math.acos(max(-1,min(1,R_of(x[5:9])[2,2]))) for x in r.tr[0]]
        if max(t)>1.2: return 'falls over: %.2f rad'%max(t)
    return Case([P(m,(0,0,0.002*s),Rx(a),mu=.3,w=tuple(Rx(a)@np.array([0,0,w])))],6*T(s),[f,above()],mu=.3)
@case('wheel_rolls_down')
def _(s):
    n=96; a=.2; R=Ry(a); nrm=R@np.array([0,0,1.]); wh=rot(prism(n,s/2,.4*s),Rx(math.pi/2))
    def f(r):
        d=np.linalg.norm(r.com[0][-1]-r.com[0][0]); x=G*math.sin(a)*2/3*r.t[-1]**2/2
        if abs(d/x-1)>.06: return 'rolled %.3f'%(d/x)
    return Case([P(wh,nrm*.5*s,R@Ry(math.pi/n*0),mu=.8,v=tuple(R@np.array([.3*math.sqrt(G*s),0,0])) if 0 else (0,0,0)),P(box(16*s,3*s,s),-nrm*s/2,R,fixed=True,mu=.8)],8*T(s),[f],floor=False)
# ---- bullets
for v in(10,100):
    def bul(s,v=v):
        def f(r):
            if r.com[0][:,0].max()>.0*s: return 'passes the wall'
        return Case([P(box(.2*s,.2*s,.2*s),(-1.5*s,.01*s,.02*s),R_of([.1,.2,.3,math.sqrt(1-.14)]),v=(v,0,0)),P(box(.02*s,2*s,2*s),(0,0,0),fixed=True)],max(3*s/v,.02),[f],floor=False,gain=None,rate=2000)
    add('bullet_wall_%d'%v,bul,steps=1)
    def bul2(s,v=v):
        def f(r):
            d=r.com[1][:,0]-r.com[0][:,0]
            if d.min()<0: return 'passes the plate'
            p=np.abs(r.Pm-r.Pm[0]).max()/np.linalg.norm(r.Pm[0])
            if p>1e-3: return 'momentum off by %.3f %%'%(100*p)
        return Case([P(box(.2*s,.2*s,.2*s),(-1.5*s,.01*s,.02*s),R_of([.1,.2,.3,math.sqrt(1-.14)]),v=(v,0,0)),P(box(.02*s,s,s),(0,0,0))],max(3*s/v,.02),[f],floor=False,gravity=(0,0,0),gain=None,rate=2000)
    add('bullet_plate_%d'%v,bul2,steps=1)
    def bul3(s,v=v):
        return Case([P(spike(4,.05*s,.3*s),(0,0,1.5*s),Rx(math.pi),v=(0,0,-v)),P(box(2*s,2*s,.02*s),(0,0,-.01*s),fixed=True)],max(3*s/v,.02),[lambda r:'passes the plate' if r.com[0][:,2].min()<0 else None],floor=False,gain=None,rate=2000)
    add('needle_plate_%d'%v,bul3,steps=1)
@case('ring_bullet_through_plate',steps=1)
def _(s):
    t=torus(.4*s,.05*s,24,8); v=20
    return Case([P(t,(0,0,2*s),Rx(1.2),v=(0,0,-v)),P(box(3*s,3*s,.02*s),(0,0,-.01*s),fixed=True)],max(4*s/v,.02),[lambda r:'passes the plate' if r.com[0][:,2].min()<0 else None],floor=False,gain=None,rate=2000)
# ---- overlap at the start, hollow
for dep in(.05,.2):
    def ovl(s,dep=dep):
        c=box(s,s,s)
        def f(r):
            sp=np.abs(r.tr[:,:,9:12]).max()/math.sqrt(G*s); 
            if sp>.5: return 'thrown apart at %.2f sqrt(g s)'%sp
        return Case([P(c,(0,0,s/2)),P(c,(0.1*s,.05*s,(1.5-dep)*s))],8*T(s),[f],pen=None,gain=None)
    add('overlap_%g'%dep,ovl)
@case('hollow')
def _(s):
    m=ring(32,square_pts(32,1.5*s),square_pts(32,1.2*s),2*s)
    ps=[P(box(s,s,s),(.3*s*(-1)**i,.2*s,.6*s+1.1*s*i),Rz(.3*i)) for i in range(3)]
    def f(r):
        for k in range(3):
            if np.abs(r.com[k][-1][:2]).max()>1.2*s: return 'part %d leaves the box'%k
    return Case(ps+[P(m,(0,0,s),fixed=True)],12*T(s),[f,above()],rate=200)
@case('rod_through_ring_falls')
def _(s):
    m=ring(24,ngon(24,.8*s),ngon(24,.5*s),.3*s)
    return Case([P(m,(0,0,.15*s)),P(box(.3*s,.3*s,2*s),(0,0,1.3*s),Ry(.3))],15*T(s),[above()])
@case('drop_e0.5')
def _(s):
    h=2*s
    def f(r):
        z=r.com[0][:,2]-.5*s; i=int(np.argmin(z[:int(len(z)*.6)])); top=z[i:].max()
        if abs(top/(.25*h)-1)>.05: return 'bounces to %.3f'%(top/(.25*h))
        if np.abs(r.tr[0][:,12:15]).max()*T(s)>.02: return 'turns by %.3f'%(np.abs(r.tr[0][:,12:15]).max()*T(s))
    return Case([P(box(s,s,s),(0,0,2.5*s),e=.5)],2.0*1.5*math.sqrt(2*h/G)/1.2,[f],e=.5)
@case('v_groove')
def _(s):
    b=box(4*s,4*s,s); R1,R2=Ry(math.pi/4),Ry(-math.pi/4); n1,n2=R1@np.array([0,0,1.]),R2@np.array([0,0,1.])
    return Case([P(box(s,s,s),(0,0,s/2*math.sqrt(2)),Ry(math.pi/4)),P(b,-n1*s/2,R1,fixed=True),P(b,-n2*s/2,R2,fixed=True)],8*T(s),[stays(0,.003,.005)],floor=False)
@case('cube_on_corner_falls')
def _(s): return Case([P(box(s,s,s),(0,0,.88*s),R_of([.32,.32,.02,math.sqrt(1-.2052)]))],15*T(s),[above(),lambda r:'lies not flat' if max(abs(up(r,0,-1,k)[2]) for k in range(3))<.9999 else None])

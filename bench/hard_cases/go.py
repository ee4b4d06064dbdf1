import sys,time; import os; sys.path.insert(0,os.path.dirname(os.path.abspath(__file__)))
from cases import *
from concurrent.futures import ThreadPoolExecutor
import argparse
a=argparse.ArgumentParser(); a.add_argument('names',nargs='*'); a.add_argument('--sizes',default='5,50,300'); a.add_argument('--steps',default='0.0025'); a.add_argument('--steps-all',action='store_true'); a.add_argument('--solver',default='sphere'); a.add_argument('--tag',default='main'); a.add_argument('-j',type=int,default=2); a.add_argument('--only-stepped',action='store_true')
o=a.parse_args()
names=[n for n in C if not o.names or any(n.startswith(x) for x in o.names)]
if o.only_stepped: names=[n for n in names if C[n][1].get('steps')]
jobs=[(n,float(s)/1e3,float(st)) for n in names for s in o.sizes.split(',') for st in o.steps.split(',')]
def one(j):
    n,s,st=j; f=os.environ.get('HARD_CASES','.')+'/run_%s/%s_%g_%g'%(o.tag,n,s*1e3,st*1e3)
    try:
        c=C[n][0](s); r=run(c,f,st,o.solver); bad,acc,why=judge(c,r)
    except Exception as e:
        import traceback; return j,['HARNESS '+repr(e)+traceback.format_exc()[-200:]],False,['harness'],0
    return j,bad,acc,why,getattr(r,'cpu',0)
out=open(os.environ.get('HARD_CASES','.')+'/res_%s.txt'%o.tag,'a')
tot=fail=0
with ThreadPoolExecutor(o.j) as ex:
    for j,bad,acc,why,cpu in ex.map(one,jobs):
        tot+=1
        if bad:
            fail+=1; l='%s %s %g mm %g ms: %s%s'%('A' if acc else 'B',j[0],j[1]*1e3,j[2]*1e3,'; '.join(bad),'' if acc else ' | '+', '.join(map(str,why)))
        else: l='. %s %g mm %g ms%s'%(j[0],j[1]*1e3,j[2]*1e3,'' if acc else ' (set apart: %s)'%', '.join(map(str,why)))
        print(l if bad or not acc else '.',flush=True) if bad or not acc else None
        out.write(l+'\n'); out.flush()
print(tot,'runs',fail,'failed',len(names),'cases')

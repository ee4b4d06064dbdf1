import sys; import os; sys.path.insert(0,os.path.dirname(os.path.abspath(__file__)))
from cases import *
n,s=sys.argv[1],float(sys.argv[2])/1e3; st=float(sys.argv[3])/1e3 if len(sys.argv)>3 else .0025
c=C[n][0](s); r=run(c,os.environ.get('HARD_CASES','.')+'/one_'+n,st); print(judge(c,r))
if not r.error:
    np.set_printoptions(precision=5,suppress=True,linewidth=160)
    for i in range(0,len(r.t),max(1,len(r.t)//int(sys.argv[4] if len(sys.argv)>4 else 40))): print('%.4f'%r.t[i],(r.tr[:,i,9:12]/math.sqrt(G*s)).round(5).tolist(), (np.array([x[i] for x in r.com])/s).round(4).tolist())
    print(r.rep['flags'],r.rep['counters'])

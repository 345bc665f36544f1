"""Texts as the rigs of PCS Instruments write them, with numbers of our own.

The layout, headings, empty columns and step types are those of ``demo_2.txt`` (EHD2) and
``demo-mtm-output.txt`` (MTM) of the package ``tribology``, github.com/moritzploss/tribology, MIT.
"""

EHD_HEAD = """EHD261 Test Data File
Profile description:\tNew EHD profile
Disc track radius:\t37.000
Lubricant name:\t
Comments:

Number of steps in profile:\t3
Test started at 09/03/2017 17:22

Step 1 "New spacer zero step" started at 09/03/2017 17:23
Step type\tFILM_ZERO\tStep description\tNew spacer zero step
       Ball load = 19.9 N
Spacer thickness = 605.8 nm

Step 2 "New film step" started at 09/03/2017 17:28
Step type\tFILM\tStep description\tNew film step
Rolling Speed (mm/s)\tAverage Film (nm)\t\t\t\t\t\t\tStep Time (s)\tLube Temp (°C)\tPot Temp (°C)\t\
Ball Load (N)\t\tBall Speed 1\tBall Speed 2\tDisc Speed 1\tDisc Speed 2\tRolling Speed (mm/s)\t\
Sliding Speed (mm/s)\tSRR (%)\t\tTraction Force 1 (N)\tTraction Force 2 (N)\tTraction Force (N)\t\
Traction Coeff (-)\t\tSD Repeat Number (-)\tUser Repeat Number (-)\tAverage Film (nm)\t\
Standard Deviation (nm)\tOrder\tLube Ref Index\tAverage Wavelength (nm)\t\tImage file name\t
"""
EHD_TAIL = """
Step 3 "New film zero check step" started at 09/03/2017 17:33
Step type\tZERO_CHECK\tStep description\tNew film zero check step
            Film thickness = 1.5 nm

All steps completed, test completed normally at 09/03/2017 17:34
"""
MTM_HEAD = """MTM311 Test Data File
Profile description:\tNew 3/4" ball on disc profile

Step 1 started at 23/03/2018 10:11:45
Step type\tTRACTION\tStep description\tNew traction step
Zero traction force (N)\t-0.5444\t(measured at the start of this step)
Disc track radius used for this step (mm)\t21.232
SRR (%)\tTraction Coeff (-)\t\t\t\t\t\t\tStep Time (s)\tPot RTD Temp (degC)\tLube RTD Temp (degC)\t\
Ball Load (N)\tPin Load (N)\tWear (um)\tECR (%)\t\tBall Speed 1\tBall Speed 2\tDisc Speed 1\t\
Disc Speed 2\tRolling Speed (mm/s)\tSliding Speed (mm/s)\tSRR (%)\t\tTF1 (N)\tTF2 (N)\t\
Traction Force (N)\tTraction Coeff (-)
"""


def ehd(rows) -> str:
    """Return an EHD2 file of a film step: speed [mm/s], film [nm], oil [°C]."""
    lines = [
        f"{u:.1f}\t{film:.1f}\t\t\t\t\t\t\t{23 + k}\t{degrees:.1f}\t{degrees - 8:.1f}\t19.931\t\t"
        f"{u:.2f}\t\t{u:.2f}\t\t{u:.2f}\t0.00\t0.000\t\t0.0114\t\t\t\t\t1\t1\t{film:.1f}\t0.00\t3\t"
        "1.396\t592.689\t\t\t"
        for k, (u, film, degrees) in enumerate(rows)
    ]
    return (EHD_HEAD + "\n".join(lines) + "\n" + EHD_TAIL).replace("\n", "\r\n")


def mtm(rows, pot=40.0, lube=40.2, kind="TRACTION") -> str:
    """Return an MTM file of a traction step: speed [mm/s], SRR [%], traction [-]."""
    lines = [
        f"{srr:.2f}\t{mu:.4f}\t\t\t\t\t\t\t{k}\t{pot:.1f}\t{lube:.1f}\t20.02\t\t0\t0\t\t{u:.2f}\t\t"
        f"{u:.2f}\t\t{u:.2f}\t{0.01 * srr * u:.2f}\t{srr:.3f}\t\t0.5\t-0.5\t0.5\t{mu:.4f}"
        for k, (u, srr, mu) in enumerate(rows)
    ]
    return MTM_HEAD.replace("TRACTION", kind) + "\n".join(lines) + "\n"

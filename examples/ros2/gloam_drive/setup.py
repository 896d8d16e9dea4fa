from setuptools import setup

setup(
    name="gloam_drive",
    version="0.1.0",
    packages=["gloam_drive"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/gloam_drive"]),
        ("share/gloam_drive", ["package.xml"]),
        ("share/gloam_drive/launch", ["launch/drive.launch.py"]),
    ],
    install_requires=["setuptools", "numpy"],
    license="Apache-2.0",
    entry_points={"console_scripts": ["drive_to_goal = gloam_drive.drive_to_goal:main"]},
)
